#pragma once

#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"

namespace joulepath {

/// What another simulator predicted for a run (`predicted:`), smoothed and thinned out like the run's own
/// channels, at the run's own samples. Channels that it does not give are empty.
struct OtherPrediction {
  Sided<Eigen::VectorXd> current_A{};
  Sided<Eigen::VectorXd> voltage_V{};
  Sided<Eigen::VectorXd> power_W{};  ///< given, or voltage times current

  bool has_power() const { return power_W.left.size() > 0 && power_W.right.size() > 0; }
};

/// One entry per run of `signals`, empty for runs without `predicted:`. The other simulator's times are read
/// as the log's; where it covers a part only, its first and last values are held.
[[nodiscard]] std::vector<OtherPrediction> other_predictions(const Dataset& dataset,
                                                             const std::vector<RunSignals>& signals,
                                                             const SignalOptions& options);

/// Ours with those channels replaced that the other simulator gives.
[[nodiscard]] Prediction in_place_of(Prediction ours, const OtherPrediction& other);

/// For the reader: how many runs carry such a prediction, its energy gap, and what of the answer is about it.
/// Empty where no run does.
[[nodiscard]] std::string told_by_others(const std::vector<RunSignals>& signals,
                                         const std::vector<OtherPrediction>& others);

}  // namespace joulepath
