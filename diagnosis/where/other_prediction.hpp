#pragma once

#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// Prediction of another simulator for a run (`predicted:`), smoothed and downsampled like the run's
/// channels, at the samples of the run. Channels that it lacks are empty.
struct OtherPrediction {
  Sided<Eigen::VectorXd> current_A{};
  Sided<Eigen::VectorXd> voltage_V{};
  Sided<Eigen::VectorXd> power_W{};  ///< given, or voltage times current

  bool has_power() const { return power_W.left.size() > 0 && power_W.right.size() > 0; }
};

/// One entry per run of `signals`, empty for runs without `predicted:`. The other simulator's times count
/// from the same origin as the log's. Where it covers only a part, its first and last values are held.
[[nodiscard]] std::vector<OtherPrediction> other_predictions(const Dataset& dataset,
                                                             const std::vector<RunSignals>& signals,
                                                             const SignalOptions& options);

/// Our prediction with the channels replaced that the other simulator provides.
[[nodiscard]] Prediction in_place_of(Prediction ours, const OtherPrediction& other);

/// A sentence for the report: the number of runs with such a prediction, its energy gap, and the parts of the
/// result that refer to it. Empty where no run has one.
[[nodiscard]] std::string told_by_others(const std::vector<RunSignals>& signals,
                                         const std::vector<OtherPrediction>& others);

}  // namespace joulepath
