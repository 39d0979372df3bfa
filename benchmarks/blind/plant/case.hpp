#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "effects.hpp"
#include "machine.hpp"
#include "protocol.hpp"
#include "sensors.hpp"
#include "world.hpp"

namespace blind {

struct CaseRequest {
  std::vector<std::string> effects{};  ///< names; empty = null
  std::vector<double> sizes{};         ///< one per effect, 0 = draw
  std::vector<double> shares{};        ///< of a large effect's size, in place of `sizes`
  std::string robot{"nomad"};
  int runs{24};
  int level{0};  ///< 0 = white noise and textbook forms, 1 = rough
  std::uint64_t seed{1};
  std::uint64_t day{0};                 ///< another day of the same machine: other runs, scatter and noise
  double noise{1.0};                    ///< factor on the deviation of every channel's noise
  bool one_log{};                       ///< the day's motions in one long log
  std::vector<std::string> appended{};  ///< descriptions of runs after the test day, see described_run
};

/// The complete truth of one case.
struct Case {
  CaseRequest request{};
  Machine nominal{};
  Machine calibrated{};  ///< nominal with the calibration error drawn, without the effects
  Machine truth{};       ///< with the effects
  World world{};
  World plain_world{};  ///< without the effects
  std::vector<Effect> effects{};
  std::vector<Run> runs{};
  SensorNoise noise{};
  double friction_scatter{};  ///< relative, per run and wheel
  double resistance_scatter{};
};

[[nodiscard]] Case draw_case(const CaseRequest& request);

/// The machine as it is in run `index` (run-to-run scatter on top of `base`).
[[nodiscard]] Machine machine_in_run(const Case& c, const Machine& base, std::size_t index);

/// The logs that perfect sensors would have written for a run (sensor distortions included).
[[nodiscard]] std::vector<Sample> noise_free_run(const Machine& truth, const Machine& nominal,
                                                 const World& world, const Run& run,
                                                 const Discretization& discretization);

/// Write robot.yaml, dataset.yaml and run_XX.csv into `folder` (made if needed).
void write_case(const Case& c, const std::string& folder);

/// Write the label, as JSON where the path ends so, else as YAML; with what the oracle says if asked,
/// and the observer.
void write_label(const Case& c, const std::string& path, bool with_oracle, bool with_observer);

}  // namespace blind
