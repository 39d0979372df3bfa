// What a calibration says about its own errors: their correlations, the model's error on held-out runs, and
// intervals of plans that hold.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "diagnosis/calibration/calibration.hpp"
#include "diagnosis/estimation/model_energy.hpp"
#include "model/model_error.hpp"
#include "model/normal_quantiles.hpp"
#include "model/nuisance_correlation.hpp"
#include "planner/mission/mission.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::LogNoise;
using testing::nomad;
using testing::swinging;
using testing::synthetic_run;

constexpr LogNoise kTypicalNoise{0.02, 0.01, 0.02};

/// A robot whose constants differ from the file's by up to a few percent.
Robot drawn_robot(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Robot robot = nomad();
  const double resistance = 1 + 0.02 * normal(random), magnet = 1 + 0.01 * normal(random),
               viscous = 1 + 0.2 * normal(random);
  for (const Side side : kSides) {
    Motor& motor = robot.motor[side];
    motor.friction_torque_Nm *= 1 + 0.05 * normal(random);
    motor.viscous_friction_Nm_s_rad *= viscous;
    motor.resistance_ohm *= resistance;
    motor.torque_constant_Nm_A *= magnet, motor.voltage_constant_V_s_rad *= magnet;
  }
  return robot;
}

/// A law that no constant has: all currents of a run are higher by a smooth share.
struct HiddenLaw {
  double share{}, phase_rad{};

  double more_A(double current_A, double time_s) const {
    return current_A * share * (1 + 0.3 * std::sin(0.5 * time_s + phase_rad));
  }
};

HiddenLaw drawn_law(double sigma, std::mt19937_64& random) {
  const double share = sigma * std::normal_distribution<double>()(random);
  return {share, std::uniform_real_distribution(-3.14, 3.14)(random)};
}

void add_hidden_law(const Robot& robot, const HiddenLaw& law, joulepath::Run& run) {
  for (std::size_t i = 0; i < run.log.size(); ++i)
    for (const Side side : kSides) {
      const double more_A = law.more_A(run.log.motor_current_A[side][i], run.log.time_s[i]);
      run.log.motor_current_A[side][i] += more_A;
      run.log.motor_voltage_V[side][i] += robot.motor[side].resistance_ohm * more_A;
    }
}

/// Energy (J) of a planned straight drive of a robot with that law, standby included.
double driven_J(const Plan& plan, const Robot& robot, const HiddenLaw& law) {
  const StretchPlan& stretch = plan.legs[0].stretches[0];
  ProfileRequest request = stretch.request;
  request.plant = make_plant(robot);
  double energy_J = robot.power.standby_W * plan.duration_s;
  integrate_profile(path_motion(request), stretch.profile, 0.0, stretch.profile.duration_s(),
                    [&](const EnergyNode& node) {
                      for (const Side side : kSides) {
                        const auto& wheel = node.wheels[side];
                        const double more_A = law.more_A(wheel.current_A, node.time_s);
                        const double voltage_V = wheel.voltage_V + robot.motor[side].resistance_ohm * more_A;
                        energy_J += node.weight_s * counted_power_W(voltage_V * (wheel.current_A + more_A),
                                                                    robot.power.regeneration_efficiency);
                      }
                    });
  return energy_J;
}

/// Runs of several speeds, payloads and turns; each has its own share of the hidden law.
Dataset runs_of(const Robot& truth, int count, double hidden_sigma, std::mt19937_64& random) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  for (int k = 0; k < count; ++k) {
    const double yaw_rad_s = k % 2 == 0 ? 0.0 : 0.5, speed_m_s = 0.35 + 0.05 * (k % 5);
    dataset.runs.push_back(synthetic_run(truth, "run_" + std::to_string(k), 12, 5.0 * (k % 3),
                                         swinging(speed_m_s, 0.6 * speed_m_s, 0.9 + 0.1 * (k % 4), yaw_rad_s),
                                         kTypicalNoise, static_cast<unsigned>(random())));
    add_hidden_law(truth, drawn_law(hidden_sigma, random), dataset.runs.back());
  }
  return dataset;
}

Robot read_back(const Robot& robot) {
  return robot_from(Document::parse(robot_text(robot), "calibrated.yaml"));
}

/// Friction against viscous friction has the scatter of the estimates over many calibrations.
TEST(WrittenUncertainty, CorrelationsAreThoseOfRepeatedCalibrations) {
  std::mt19937_64 random(3);
  const Robot truth = drawn_robot(random);
  constexpr int kRepeats = 60;
  Eigen::Matrix<double, kRepeats, 2> estimates;
  double stated = 0.0;
  for (int k = 0; k < kRepeats; ++k) {
    const Robot robot = calibrate(runs_of(truth, 10, 0.02, random), CalibrationMethod::full).robot;
    estimates.row(k) << robot.motor.left.friction_torque_Nm, robot.motor.left.viscous_friction_Nm_s_rad;
    stated += stated_correlation(robot, "friction_torque_Nm", "viscous_friction_Nm_s_rad") / kRepeats;
  }
  const Eigen::MatrixXd centered = estimates.rowwise() - estimates.colwise().mean();
  const double scatter = correlation_of(centered.transpose() * centered)(0, 1);
  EXPECT_LT(scatter, -0.5);
  EXPECT_NEAR(stated, scatter, 0.2);
}

/// Every file reads back, and every matrix of rounded correlations is positive definite.
TEST(WrittenUncertainty, FilesReadBackWithTheSameCorrelations) {
  std::mt19937_64 random(5);
  for (const int count : {4, 7, 12})
    for (const CalibrationMethod method : {CalibrationMethod::full, CalibrationMethod::steady}) {
      Dataset dataset = runs_of(drawn_robot(random), count, 0.05, random);
      for (int k = 0; k < count; ++k)
        dataset.runs.push_back(synthetic_run(nomad(), "steady_" + std::to_string(k), 6, 0,
                                             testing::constant_speed(0.2 + 0.1 * k), kTypicalNoise));
      dataset.robot.uncertainty["chassis_mass_kg"] = 0.01;
      const Robot robot = calibrate(dataset, method).robot, again = read_back(robot);
      EXPECT_EQ(again.uncertainty_correlations, robot.uncertainty_correlations);
      EXPECT_FALSE(robot.uncertainty_correlations.empty());
      EXPECT_TRUE(cholesky_factor(nuisance_correlation(again)));
      for (const Correlation& pair : again.uncertainty_correlations) {
        EXPECT_GE(std::abs(pair.correlation), 0.05);
        EXPECT_NEAR(100 * pair.correlation, std::round(100 * pair.correlation), 1e-9);
      }
    }
}

/// Near the edge of what errors can have together, rounding alone would leave no such matrix.
TEST(WrittenUncertainty, RoundedCorrelationsStayPositiveDefinite) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const std::vector<std::string> keys{"friction_torque_Nm", "resistance_ohm", "torque_constant_Nm_A",
                                      "viscous_friction_Nm_s_rad"};
  int singular = 0;
  for (int draw = 0; draw < 100; ++draw) {
    const Eigen::MatrixXd directions = Eigen::MatrixXd::NullaryExpr(4, 2, [&] { return normal(random); });
    Robot robot = nomad();
    robot.uncertainty.clear();
    for (const std::string& key : keys) robot.uncertainty[key] = 0.02;
    const Eigen::MatrixXd matrix = correlation_of(directions * directions.transpose());
    singular += !cholesky_factor(matrix);
    state_correlations(keys, matrix, robot);
    EXPECT_TRUE(cholesky_factor(nuisance_correlation(robot)));
    EXPECT_EQ(refusal_of(robot), "");
    for (const Correlation& pair : robot.uncertainty_correlations) {
      const auto index = [&](const std::string& key) {
        return std::find(keys.begin(), keys.end(), key) - keys.begin();
      };
      EXPECT_NEAR(pair.correlation, matrix(index(pair.first), index(pair.second)), 0.15);
    }
  }
  EXPECT_EQ(singular, 100);
}

/// A law of another family that differs from run to run: its size is found within its sampling interval, and
/// without it what is written is the noise.
TEST(WrittenUncertainty, ModelErrorIsThatOfRunsWhichServedForNoConstant) {
  constexpr int kSets = 6, kRuns = 16;
  for (const double hidden : {0.0, 0.03, 0.06}) {
    std::mt19937_64 random(11);
    double found = 0.0, true_square = 0.0;
    for (int set = 0; set < kSets; ++set) {
      const Robot truth = drawn_robot(random);
      const Dataset dataset = runs_of(truth, kRuns, hidden, random);
      for (const joulepath::Run& run : dataset.runs)
        true_square += std::pow(motion_energy_error(run, truth)->error, 2) / (kSets * kRuns);
      const Robot robot = calibrate(dataset, CalibrationMethod::full).robot;
      found += *read_back(robot).model_energy_sigma() / kSets;
    }
    if (hidden == 0) {
      EXPECT_LT(found, 0.004);
      continue;
    }
    const double sampling = 2.6 / std::sqrt(2.0 * kSets * (kRuns - 1)), students_t = 2.131 / kNormal95;
    EXPECT_NEAR(found / std::sqrt(true_square), students_t, sampling * students_t);
  }
}

/// The offset of a sensor is many times the energy of a robot that stands.
TEST(WrittenUncertainty, ARunThatHardlyMovesDoesNotCount) {
  Robot robot = nomad();
  std::vector<MotionEnergyError> errors(8, {.error = 0.02, .energy_J = 100});
  errors.push_back({.error = 49, .energy_J = 0.01});
  (void)write_model_energy(errors, robot);
  EXPECT_GE(robot.uncertainty.at("model_energy"), 0.02);
  EXPECT_LT(robot.uncertainty.at("model_energy"), 0.03);
}

TEST(WrittenUncertainty, FewRunsStateNoModelError) {
  std::mt19937_64 random(13);
  Dataset dataset = runs_of(drawn_robot(random), kLeastHeldOutRuns - 1, 0.06, random);
  dataset.robot.uncertainty.clear();
  const CalibrationResult result = calibrate(dataset, CalibrationMethod::full);
  EXPECT_FALSE(result.robot.model_energy_sigma());
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(), [](const std::string& note) {
    return note.starts_with("model_energy is not measured: 5 held-out runs") &&
           note.find("6 are needed") != std::string::npos;
  }));
}

/// Energies of fresh drives of a plan, which has an interval from the calibrated file: it holds 95 %.
TEST(WrittenUncertainty, IntervalsOfPlansHoldTheEnergiesOfFreshRuns) {
  const LegRequest leg{.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}}},
                       .payload = {5.0, 5.0}};
  std::mt19937_64 random(17);
  int held = 0, all = 0;
  for (int set = 0; set < 40; ++set) {
    const Robot truth = drawn_robot(random);
    const Robot file = read_back(calibrate(runs_of(truth, 10, 0.05, random), CalibrationMethod::full).robot);
    const Plan plan = plan_mission({.name = "fresh", .legs = {leg}}, {.robot = file},
                                   {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
    ASSERT_TRUE(plan.energy_sigma_J && plan.sigma_has_model_error);
    for (int drive = 0; drive < 5; ++drive, ++all) {
      const double true_J = driven_J(plan, truth, drawn_law(0.05, random));
      held += std::abs(true_J - plan.energy.total_J()) < kNormal95 * *plan.energy_sigma_J;
    }
  }
  EXPECT_GE(held, 0.9 * all) << "of " << all;
}

}  // namespace
}  // namespace joulepath
