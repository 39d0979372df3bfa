#pragma once

#include <string>
#include <vector>

#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Prediction of another simulator for a run (`predicted:`), smoothed and downsampled like the run's
/// channels, at the samples of the run. Channels that it lacks are empty.
struct OtherPrediction {
  Sided<Eigen::VectorXd> current_A{};
  Sided<Eigen::VectorXd> voltage_V{};
  Sided<Eigen::VectorXd> power_W{};  ///< given, or voltage times current
  Eigen::VectorXd battery_power_W{};

  bool has_motor_power() const { return power_W.left.size() > 0 && power_W.right.size() > 0; }
};

/// One entry per run of `signals`, empty for runs without `predicted:`. The other simulator's times count
/// from the same origin as the log's. Where it covers only a part, its first and last values are held.
[[nodiscard]] std::vector<OtherPrediction> other_predictions(const Dataset& dataset,
                                                             const std::vector<RunSignals>& signals,
                                                             const SignalOptions& options);

/// Our prediction with the channels replaced that the other simulator provides.
[[nodiscard]] Prediction in_place_of(Prediction ours, const OtherPrediction& other);

/// Energy gap of the other simulator over the runs where it and the log have a power of the same place: of
/// both motors, else at the battery's terminals. `noise_floor_percent`: of the runs, whatever model predicts.
[[nodiscard]] SimulatorGap simulator_gap(const std::vector<RunSignals>& signals,
                                         const std::vector<OtherPrediction>& others,
                                         double noise_floor_percent);

/// The verdict where a simulator predicts: on the simulator, whatever is wrong with the robot file. No cause
/// of the file explains a simulator's gap. Runs too few for a verdict on the file give the simulator no
/// all-clear.
[[nodiscard]] Verdict verdict_with(const SimulatorGap& simulator);

/// A sentence for the report: what refers to the other simulator, and what to this model. Empty where no run
/// has such a prediction.
[[nodiscard]] std::string told_by_others(const Dataset& dataset, const SimulatorGap& simulator);

}  // namespace joulepath
