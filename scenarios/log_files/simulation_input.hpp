#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/motions.hpp"
#include "model/robot.hpp"
#include "model/simulation/simulate.hpp"
#include "planner/legs/stretch.hpp"
#include "planner/values/plan.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The input of a simulation: a plan's directory, a trajectory or log (CSV), or a mission.
struct SimulationInput {
  std::string name{};
  Robot robot{};
  Trajectory reference{};
  std::vector<Interval> coasting{};
  Pose start{};
  double planned_energy_J{};  ///< at the battery's terminals, standby included
  double planned_duration_s{};
  std::string infeasible{};  ///< reason why the mission has no plan; empty: it has one
};

/// Reads the input at `path`. A mission with only prescribed motions is driven as prescribed; any other is
/// planned first. `robot_file` replaces the mission's; a plan or trajectory needs it.
/// Throws ConfigError.
[[nodiscard]] SimulationInput read_simulation_input(const std::string& path, const std::string& robot_file,
                                                    const ReadOptions& options = {},
                                                    const PlanOptions& planning = {});

/// The input of a simulation from a plan. The robot may differ from the plan's.
[[nodiscard]] SimulationInput simulation_input(const Plan& plan, const Trajectory& trajectory,
                                               const Robot& robot);

/// The run of an input on a plant with additional effects: typical sensors, or ideal ones.
[[nodiscard]] SimulationRequest simulation_request(const SimulationInput& input,
                                                   const std::vector<EffectSetting>& effects,
                                                   bool ideal_sensors, std::uint64_t seed);

/// A text `NAME:KEY=VALUE,...`; the value is empty for a key without `=`.
struct NamedSettings {
  std::string name{};
  std::vector<std::pair<std::string, std::string>> settings{};
};
[[nodiscard]] NamedSettings split_settings(const std::string& text);

/// `NAME:PARAMETER=VALUE,...` as an effect of the catalog; `side=left` for effects with a side.
/// Throws ConfigError.
[[nodiscard]] EffectSetting parse_effect(const std::string& text);

}  // namespace joulepath
