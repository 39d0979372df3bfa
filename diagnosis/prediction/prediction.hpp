#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/channels.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// A model that logs are held against: constants, effects, and what instruments do to a log.
struct ModelPoint {
  Robot robot{};
  std::vector<EffectSetting> effects{};  ///< beyond those of the robot file
  double payload_factor{1.0};            ///< weighing error of all payloads
  double contact_creep_m_s_N{};          ///< that every tire has, effects apart
  double channel_delay_s{};              ///< of the motors' readings, beyond that of the effects
};

/// What a model predicts for the motion that a run measured.
struct Prediction {
  Sided<Eigen::VectorXd> current_A{};  ///< as a sensor shows them, instrument effects included
  Sided<Eigen::VectorXd> voltage_V{};
  Sided<Eigen::VectorXd> power_W{};  ///< voltage times current, as the log shows it
  Eigen::VectorXd battery_power_W{};
  Eigen::VectorXd battery_voltage_V{};  ///< with the measured battery current
  Eigen::VectorXd yaw_rate_rad_s{};
  Eigen::VectorXd heading_rad{};  ///< change since the run's start, from the wheels
  Eigen::VectorXd x_m{};          ///< change since the run's start, from the wheels along the heading
  Eigen::VectorXd y_m{};
};

/// The rows of one run: one column per Channel. A row that does not count (channel absent, wheel
/// near standstill) has `present` false.
struct ResidualRows {
  Eigen::MatrixXd value{};  ///< samples x kChannelCount
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> present{};
};

[[nodiscard]] Prediction predict(const RunSignals& signals, const ModelPoint& point);

/// Measured less predicted, in structured rows.
[[nodiscard]] ResidualRows residual_rows(const RunSignals& signals, const ModelPoint& point,
                                         const Prediction& prediction);

/// How structured rows change from one prediction to another: the signature of what was changed.
/// Free of noise, as only predictions enter.
[[nodiscard]] Eigen::MatrixXd signature_rows(const RunSignals& signals, const ModelPoint& point,
                                             const Prediction& base, const Prediction& changed);

}  // namespace joulepath
