#pragma once

#include <string>
#include <vector>

#include "diagnosis/simulator/alignment.hpp"

namespace joulepath {

/// Whether a run has the log that the user's own simulator gave for it (`predicted:`).
[[nodiscard]] bool has_prediction(const Run& run);

/// The simulator's logs in place of the robot's, for the runs that have both.
[[nodiscard]] Dataset simulator_dataset(const Dataset& dataset);

/// The runs that have both, with what the simulator predicts beyond the model of `robot` at its own motion: a
/// control variate. Added to the model at the robot's motion it gives the simulator's prediction of that
/// motion, so an error that the model makes in both leaves no gap.
struct ComparedRuns {
  Dataset dataset{};                    ///< of `robot`
  std::vector<std::size_t> indices{};   ///< of its runs in the whole dataset
  std::vector<Alignment> alignments{};  ///< of each run
  std::vector<std::string> lacking{};   ///< channels of the robot that a prediction lacks: the model's stay
};

/// Throws ConfigError for a prediction whose motion is not that of its run.
[[nodiscard]] ComparedRuns compare_runs(const Dataset& dataset, const Robot& robot);

}  // namespace joulepath
