#pragma once

#include <array>
#include <optional>
#include <vector>

#include "model/plant.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A quantity of a plan over time, and its 1-sigma.
struct PlanBand {
  std::vector<double> time_s{};
  std::vector<double> value{};
  std::vector<double> sigma{};
};

/// The lower and the upper ends of the 95 % intervals.
[[nodiscard]] std::array<std::vector<double>, 2> ends_95(const PlanBand& band);

/// What the robot file's `uncertainty:` says along a plan, to first order as in find_energy_sigmas(): each
/// uncertain constant is one sigma more and less along the planned motion, the correlations count, and the
/// model's own error is in proportion to the power of the motion. Winding temperatures have no error of the
/// model. A quantity that is certain or that the robot has not is absent.
struct PlanBands {
  std::optional<PlanBand> battery_power_W{};
  std::optional<PlanBand> energy_J{};
  std::optional<PlanBand> battery_fraction{};
  std::optional<PlanBand> winding_C{};  ///< of the side that becomes hotter
};

/// At least at these times (s) of the plan; temperatures at about as many of their own.
[[nodiscard]] PlanBands plan_bands(const Plan& plan, const Plant& plant, const std::vector<double>& times_s);

}  // namespace joulepath
