// The rows of a channel vanish where its own equation is true, whatever happens in the other channels.
#include <gtest/gtest.h>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;

/// A robot whose both motors feed a battery that sags.
Robot with_battery() {
  Robot robot = nomad();
  robot.power.regeneration_efficiency = 0.4;
  robot.battery = {.open_circuit_voltage_V = 25.0, .internal_resistance_ohm = 0.05};
  return robot;
}

/// What all sensors read of a robot that is `truth` on a run, without noise.
RunSignals measured(const ModelPoint& truth, double time_of_day_s) {
  const Robot robot = with_battery();
  RunSignals run = make_run_signals(
      testing::synthetic_run(robot, "weaving", 15, 3.0, testing::swinging(0.5, 0.2, 1.1, 0.5)), 0, robot);
  run.time_of_day_s.array() += time_of_day_s;
  run.battery_current_A = Eigen::VectorXd::LinSpaced(run.size(), 0.4, 3.0);
  run.heading_measured = true;
  run.x_m = run.y_m = Eigen::VectorXd::Zero(run.size());
  run.motor_current_A = predict(run, truth).current_A;  // whose sign a driver's drop has
  const Prediction p = predict(run, truth);
  run.motor_voltage_V = p.voltage_V, run.motor_power_W = p.power_W;
  run.battery_power_W = p.battery_power_W, run.battery_voltage_V = p.battery_voltage_V;
  run.gyro_yaw_rate_rad_s = p.yaw_rate_rad_s;
  mark_conducting(run, robot);
  return run;
}

EffectSetting typical(const Candidate& candidate) {
  return setting_of(candidate, candidate.step, with_battery());
}

/// A mechanical gap beside the true electrical model: V - R i - Kv n q' holds with the measured current, for
/// every effect and every two, be they of the winding, of the driver or of the reading.
TEST(WindingRow, KnowsNothingOfAMechanicalGap) {
  const EffectSetting friction{.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.15}}},
      gain{.name = "current_sensor_gain", .parameters = {{"fraction", -0.2}}},
      heating{.name = "winding_heating",
              .parameters = {{"final_fraction", 0.4}, {"time_constant_s", 60.0}}};
  for (const Candidate& candidate : catalog_candidates(with_battery())) {
    if (candidate.effect().delays_channels) continue;  // the signals are read at their delay
    for (const std::vector<EffectSetting>& beside :
         {std::vector<EffectSetting>{}, std::vector{gain}, std::vector{heating, gain}}) {
      ModelPoint known{.robot = with_battery(), .effects = beside};
      known.effects.push_back(typical(candidate));
      ModelPoint truth = known;
      truth.effects.push_back(friction);
      const RunSignals run = measured(truth, 90.0);
      const Prediction p = predict(run, known);
      const ResidualRows rows = residual_rows(run, known, p);
      ASSERT_GT(rows.value.col(kCurrentLeft).cwiseAbs().minCoeff(), 0.02) << "a gap that the row must ignore";
      for (const Channel channel : {kWindingLeft, kWindingRight})
        EXPECT_LT(rows.value.col(channel).cwiseAbs().maxCoeff(), 1e-9)
            << candidate.label() << " beside " << beside.size();
      const Eigen::MatrixXd columns = signature_rows(run, known, p, predict(run, truth));
      EXPECT_LT(columns.middleCols(kWindingLeft, 2).cwiseAbs().maxCoeff(), 1e-9) << candidate.label();
    }
  }
}

}  // namespace
}  // namespace joulepath
