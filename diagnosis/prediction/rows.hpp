#pragma once

#include <Eigen/Core>

#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/values/channels.hpp"

namespace joulepath {

/// Rows of one run: one column per Channel. `present` is false for a row that does not count (absent channel,
/// wheel near standstill).
struct ResidualRows {
  Eigen::MatrixXd value{};  ///< samples x kChannelCount
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> present{};
};

/// Takes the mean off heading and positions: the offset of a run's pose is free.
void remove_pose_means(Eigen::MatrixXd& rows);

/// Measured minus predicted values as structured rows.
[[nodiscard]] ResidualRows residual_rows(const RunSignals& signals, const ModelPoint& point,
                                         const Prediction& prediction);

/// Difference of the structured rows of two predictions: the signature of the changed parameter. Free of
/// noise, because only predictions enter.
[[nodiscard]] Eigen::MatrixXd signature_rows(const RunSignals& signals, const ModelPoint& point,
                                             const Prediction& base, const Prediction& changed);

}  // namespace joulepath
