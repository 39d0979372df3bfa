// A battery's open-circuit voltage goes with its charge: no gap. Its internal resistance is one.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/evidence/equations.hpp"
#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr double kVoltageNoise_V = 0.01;

/// What the equations of a day say whose runs begin at `offset_V[r]` beside the file's open-circuit voltage
/// and lose `fall_V[r]` by the charge that they draw.
Equations equations_of(const Robot& robot, const std::vector<double>& offset_V,
                       const std::vector<double>& fall_V) {
  const auto weaving = testing::swinging(0.5, 0.2, 1.1, 0.5);
  std::vector<RunSignals> signals;
  for (std::size_t r = 0; r < offset_V.size(); ++r) {
    const double payload_kg = 5.0 * static_cast<double>(r);
    RunSignals run =
        make_run_signals(testing::synthetic_run(robot, "weaving", 15, payload_kg, weaving), r, robot);
    run.battery_current_A = (predict(run, {.robot = robot}).battery_power_W / 25.0).eval();
    const Prediction p = predict(run, {.robot = robot});
    run.battery_power_W = p.battery_power_W, run.battery_voltage_V = p.battery_voltage_V;
    double drawn = 0;
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      drawn += run.battery_current_A[j] / run.battery_current_A.sum();
      run.battery_voltage_V[j] += offset_V[r] - fall_V[r] * drawn;
    }
    signals.push_back(run);
  }
  NoiseModel noise;
  noise.channel_sd.fill(kVoltageNoise_V);
  noise.innovation_covariance.setIdentity();
  noise.innovation_covariance *= kVoltageNoise_V * kVoltageNoise_V;
  const Eigen::VectorXd variance = run_start_variance(robot);
  const std::vector<Nuisance> nuisances = calibration_nuisances(robot);
  const ModelState state{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
  return build_equations(signals, robot, nuisances, state, {}, {.noise = &noise, .run_variance = &variance});
}

/// Whatever the charge of each run, no column of the catalog or the dictionary gets evidence from it.
TEST(OpenCircuitVoltage, OfARunIsFree) {
  const Robot robot = testing::nomad();
  ASSERT_TRUE(std::isfinite(robot.battery.open_circuit_voltage_V));
  const std::vector<double> none(3, 0.0);
  const Equations full = equations_of(robot, none, none);
  const auto sum = [](const Equations& e) { return sum_runs(e.runs, every(e.runs.size()), e.prior_sd); };
  const LinearProblem at_full = sum(full);
  for (const auto& [offset_V, fall_V] :
       {std::pair{std::vector{0.0, -0.03, -0.06}, std::vector{0.03, 0.03, 0.03}},
        std::pair{std::vector{0.4, 0.4, 0.4}, none},
        std::pair{std::vector{0.2, -0.5, 0.1}, std::vector{0.0, 0.3, -0.2}}}) {
    const LinearProblem other = sum(equations_of(robot, offset_V, fall_V));
    EXPECT_LT(std::abs(other.residual_square - at_full.residual_square), 0.5);
    for (Eigen::Index k = 0; k < at_full.right.size(); ++k)
      EXPECT_LT(std::abs(other.right[k] - at_full.right[k]), std::sqrt(at_full.gram(k, k)) + 1e-9)
          << "one sigma of column " << k;
  }
}

TEST(OpenCircuitVoltage, LeavesTheInternalResistanceToTheCurrent) {
  const Robot robot = testing::nomad();
  const std::vector<double> none(3, 0.0);
  const Equations equations = equations_of(robot, none, none);
  const LinearProblem problem = sum_runs(equations.runs, every(3), equations.prior_sd);
  for (std::size_t c = 0; c < equations.candidates.size(); ++c)
    if (equations.candidates[c].shape.name == "supply_sag") {
      const int k = equations.columns_of_candidate(static_cast<int>(c), false).front();
      EXPECT_GT(0.05 * std::sqrt(problem.gram(k, k)), 5.0) << "sigmas of 50 milliohms";
    }
}

/// The day with a battery that loses `fall_V` by its end, the power unchanged.
Dataset discharging(Dataset day, double fall_V) {
  double total_A = 0, drawn_A = 0;
  for (const Run& run : day.runs)
    for (const double current_A : run.log.battery_current_A) total_A += current_A;
  for (Run& run : day.runs)
    for (std::size_t i = 0; i < run.log.size(); ++i) {
      double &volts = run.log.battery_voltage_V[i], &amperes = run.log.battery_current_A[i];
      const double power_W = volts * amperes;
      drawn_A += amperes;
      volts -= fall_V * drawn_A / total_A;
      amperes = power_W / volts;
    }
  return day;
}

TEST(DischargingBattery, IsNoGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d =
      diagnose(discharging(testing::blind_day("none", 0, 0, 12, 902), 0.09), {.bootstrap = 0});
  EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict) << " " << d.leftover_description;
}

TEST(DischargingBattery, StillShowsItsResistance) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d =
      diagnose(discharging(testing::blind_day("supply_sag", 0.4, 0, 12, 903), 0.5), {.bootstrap = 0});
  EXPECT_EQ(d.verdict, Verdict::explained) << verdict_name(d.verdict) << " " << d.leftover_description;
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes.front().effect.name, "supply_sag");
  EXPECT_NEAR(d.causes.front().parameters.front().value, 0.4, 0.05);
}

}  // namespace
}  // namespace joulepath
