#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/prediction/body_lag.hpp"
#include "diagnosis/signals/run_signals.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// A model to compare with logs: constants, effects, and the effects of instruments on a log.
struct ModelPoint {
  Robot robot{};
  std::vector<EffectSetting> effects{};  ///< in addition to those of the robot file
  double payload_factor{1.0};            ///< weighing error of all payloads
  double contact_creep_m_s_N{};          ///< creep of every tire, without the effects
  /// Of the body behind its rotors, in addition to the contacts' creep, at the samples of one run; or empty.
  BodyLag swing{};
  /// Of the contacts on a straight line after a turn to the left or to the right, in the turn's direction.
  Sided<double> held_moment_Nm{};
  double channel_delay_s{};  ///< delay of the motors' readings in addition to that of the effects
};

/// Prediction of a model for the measured motion of a run.
struct Prediction {
  Sided<Eigen::VectorXd> current_A{};  ///< as a sensor reads them, effects of instruments included
  Sided<Eigen::VectorXd> voltage_V{};
  /// Mean over the smoothing kernel of voltage times current, in the convention of the log.
  Sided<Eigen::VectorXd> power_W{};
  Sided<Eigen::VectorXd> power_change_W{};  ///< of it within the kernel, 1 sigma
  /// What one more ampere of the reading adds to the winding's voltage: the resistance with its effects, over
  /// the reading's gain.
  Sided<Eigen::VectorXd> reading_resistance_ohm{};
  Eigen::VectorXd battery_power_W{};
  Eigen::VectorXd battery_voltage_V{};  ///< at the measured battery current
  Eigen::VectorXd yaw_rate_rad_s{};
  Eigen::VectorXd heading_rad{};  ///< change since the run's start, from the wheels
  Eigen::VectorXd x_m{};          ///< change since the run's start, from the wheels along the heading
  Eigen::VectorXd y_m{};
};

/// What the supply of a predicted run gives to the motors at sample j, W. What a mean over the kernel hides
/// is as the log shows it, or as its samples let expect it.
[[nodiscard]] double supply_W(const RunSignals& signals, const PowerSupply& supply,
                              const Prediction& prediction, Eigen::Index j);

/// Of the model; with a simulator's deviation (RunSignals::deviation) of the model and that, which is the
/// simulator's prediction of the measured motion.
[[nodiscard]] Prediction predict(const RunSignals& signals, const ModelPoint& point);

}  // namespace joulepath
