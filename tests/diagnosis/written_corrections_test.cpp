// Every robot that a diagnosis writes reads back: calibration constants in their boxes, values that the
// schema accepts.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "diagnosis/correction/judged_model.hpp"
#include "model/estimate.hpp"
#include "model/motions.hpp"
#include "model/normal_quantiles.hpp"
#include "model/nuisance_correlation.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/result_files/next_step.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/practice_sets.hpp"
#include "tests/support/practice_truth.hpp"

namespace joulepath {
namespace {

/// Constants of the left wheel's robot by their keys in `uncertainty:`.
double constant_of(const Robot& robot, const std::string& key) {
  if (key == "chassis_mass_kg") return robot.inertia.chassis_mass_kg;
  if (key == "wheel_axle_inertia_kg_m2") return robot.inertia.wheel_axle_inertia_kg_m2;
  if (key == "resistance_ohm") return robot.motor.left.resistance_ohm;
  return robot.motor.left.friction_torque_Nm;
}

/// Fits that leave their boxes by any factor, for uncertainties from 1 % to total.
TEST(WrittenCorrection, KeepsEveryConstantInItsBoxAndItsSign) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  for (int draw = 0; draw < 200; ++draw) {
    Dataset dataset{.robot = testing::nomad()};
    Robot& robot = dataset.robot;
    const double sigma = std::pow(10, uniform(-2, 0));
    for (const char* key :
         {"chassis_mass_kg", "wheel_axle_inertia_kg_m2", "resistance_ohm", "friction_torque_Nm"})
      robot.uncertainty[key] = sigma;
    const RunsByUse runs;
    const Identification id{.nuisances = calibration_nuisances(robot)};
    const Examination x{.dataset = dataset, .runs = runs, .id = id};
    ModelState fit;
    for (std::size_t k = 0; k < id.nuisances.size(); ++k)
      fit.nuisance_fraction.push_back(uniform(-10, 10) * sigma);
    const ModelState boxed = within_calibration(x, fit);
    const Robot written = corrected_robot(x, boxed);
    EXPECT_EQ(refusal_of(written), "") << sigma;
    for (const auto& [key, width] : robot.uncertainty) {
      const double factor = constant_of(written, key) / constant_of(robot, key);
      EXPECT_LE(factor, 1 + 3 * width + 1e-12) << key;
      EXPECT_GE(factor, 1 / (1 + 3 * width) - 1e-12) << key;
    }
    for (std::size_t k = 0; k < id.nuisances.size(); ++k) {
      const double sd = id.nuisances[k].sigma, fraction = fit.nuisance_fraction[k];
      if (std::abs(fraction) > 3 * sd / (1 + 3 * sd)) continue;
      EXPECT_EQ(boxed.nuisance_fraction[k], fraction) << "inside its box a fit stays";
    }
  }
}

/// A cart on a slope whose encoder lags behind the wheel: its inertia seems smaller than none.
struct Cart {
  double torque_constant{}, slope{}, lag_s{};
};

Run slope_run(const Cart& cart, const Robot& robot, int n) {
  std::mt19937_64 random(static_cast<std::uint64_t>(n) + 4);
  std::normal_distribution<double> normal;
  const double mass_kg = 0.9, inertia = 2e-4, radius_m = 0.033, up = n % 2 == 0 ? 1 : -1, dt_s = 1e-3;
  const Motor& motor = robot.motor.left;
  Run run{.name = "run_" + std::to_string(n), .payload = {{0, 0}}, .payload_known = true};
  double speed = 0, read = 0, integral = 0;
  for (int k = 0; k < 4000; ++k) {
    const double t = k * dt_s, error = (t > 0.3 && t < 3.3 ? 10 * up : 0) - read;
    integral += error * dt_s;
    const double current = std::clamp(0.05 * error + 0.25 * integral, -1.0, 1.0);
    const double load =
        mass_kg * 9.81 * cart.slope * radius_m / 2 + motor.friction_torque_Nm * std::tanh(speed / 0.2);
    speed += dt_s * (cart.torque_constant * current - load) / (inertia + mass_kg * radius_m * radius_m / 2);
    read += dt_s * (speed - read) / cart.lag_s;
    if (k % 20 != 0) continue;
    run.log.time_s.push_back(t);
    for (Side side : kSides) {
      run.log.wheel_speed_rad_s[side].push_back(read + 0.02 * normal(random));
      run.log.motor_voltage_V[side].push_back(motor.resistance_ohm * current + cart.torque_constant * speed +
                                              0.02 * normal(random));
      run.log.motor_current_A[side].push_back(current + 0.002 * normal(random));
    }
  }
  return run;
}

Dataset slope_day(const Cart& cart) {
  Dataset dataset{.robot = testing::nomad()};
  Robot& robot = dataset.robot;
  robot.geometry = {.wheel_radius_m = {0.033, 0.033}, .half_track_m = 0.077};
  robot.inertia = {0.84, 0.03, 0.004, 0.01, 4e-4, 2e-5};
  for (Side side : kSides)
    robot.motor[side] = {.gear_ratio = 1,
                         .resistance_ohm = 12.6,
                         .torque_constant_Nm_A = 0.458,
                         .voltage_constant_V_s_rad = 0.458,
                         .viscous_friction_Nm_s_rad = 1e-4,
                         .friction_torque_Nm = 0.0195,
                         .max_voltage_V = 12};
  robot.uncertainty = {{"friction_torque_Nm", 0.1},    {"resistance_ohm", 0.05},
                       {"torque_constant_Nm_A", 0.02}, {"voltage_constant_V_s_rad", 0.05},
                       {"chassis_mass_kg", 0.25},      {"wheel_axle_inertia_kg_m2", 0.5}};
  for (int n = 0; n < 6; ++n) dataset.runs.push_back(slope_run(cart, robot, n));
  return dataset;
}

TEST(WrittenCorrection, OfAFitThatNoRobotHasReadsBackOrIsRefusedWithTheReason) {
  for (const Cart& cart : {Cart{0.458, 0.15, 0.02}, Cart{0.54, 0.15, 0.02}}) {
    const Diagnosis d = diagnose(slope_day(cart), {.bootstrap = 20, .refusal = refusal_of});
    EXPECT_EQ(d.corrected_robot ? refusal_of(*d.corrected_robot) : "", "");
    EXPECT_NE(next_step(d).find(d.refused_correction), std::string::npos);
  }
}

/// Where the program reads no correction at all, none is written, nothing is called explained, and the answer
/// says why.
TEST(WrittenCorrection, IsNotWrittenWhereTheProgramRefusesIt) {
  Dataset dataset = slope_day({0.458, 0.15, 0.02});
  const Diagnosis d =
      diagnose(dataset, {.bootstrap = 20, .refusal = [](const Robot&) { return "motor: no"; }});
  EXPECT_FALSE(d.corrected_robot);
  EXPECT_NE(d.verdict, Verdict::explained);
  ASSERT_EQ(d.refused_correction, "motor: no");
  EXPECT_NE(next_step(d).find("motor: no"), std::string::npos) << next_step(d);
}

/// Squares of the errors of a file's friction, resistance and torque constant, whitened by its covariance.
double whitened_square(const Robot& file, const Robot& truth) {
  const std::vector<Nuisance> nuisances = nuisances_of(file);
  std::vector<Eigen::Index> rows;
  std::vector<double> errors;
  for (std::size_t k = 0; k < nuisances.size(); ++k) {
    const Side side = nuisances[k].side.value_or(Side::left);
    const auto add = [&](const char* key, double Motor::*constant) {
      if (nuisances[k].key != key) return;
      rows.push_back(static_cast<Eigen::Index>(k));
      errors.push_back((truth.motor[side].*constant / (file.motor[side].*constant) - 1) / nuisances[k].sigma);
    };
    add("friction_torque_Nm", &Motor::friction_torque_Nm);
    add("viscous_friction_Nm_s_rad", &Motor::viscous_friction_Nm_s_rad);
    add("resistance_ohm", &Motor::resistance_ohm);
    add("torque_constant_Nm_A", &Motor::torque_constant_Nm_A);
  }
  const Eigen::VectorXd error = Eigen::VectorXd::Map(errors.data(), std::ssize(errors));
  return error.dot(Eigen::MatrixXd(nuisance_correlation(file)(rows, rows)).llt().solve(error));
}

/// A corrected file's intervals hold the energies of the labelled robot, on motions that no run has.
TEST(WrittenCorrection, StatesErrorsThatHoldTheTruth) {
  double squares = 0.0;
  for (const char* set : {"p03_rolling_resistance", "p05_floor_slope", "p09_track_width_error_rough"}) {
    const Dataset dataset = read_dataset(testing::practice_file(set));
    const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
    ASSERT_TRUE(d.corrected_robot) << set;
    const Robot file = robot_from(Document::parse(robot_text(*d.corrected_robot), "corrected.yaml"));
    EXPECT_EQ(file.uncertainty_correlations, d.corrected_robot->uncertainty_correlations);
    for (const auto& [key, sigma] : dataset.robot.uncertainty)
      EXPECT_LT(file.uncertainty.at(key), 1.1 * sigma) << set << key;
    ASSERT_TRUE(file.model_energy_sigma()) << set;
    const Robot truth = testing::true_robot(dataset.robot, testing::practice_file(set, "truth.yaml"));
    squares += whitened_square(file, truth);
    Robot limited = dataset.robot;
    limited.limits = testing::nomad().limits;
    for (const double speed_m_s : {0.25, 0.45, 0.65}) {
      const Trajectory motion =
          timed_motion(
              limited,
              {{.profile = MotionProfile::trapezoid, .speed_m_s = speed_m_s, .distance_m = 5},
               {.profile = MotionProfile::arc, .speed_m_s = speed_m_s, .radius_m = 1.5, .angle_rad = 2}},
              {.payload_kg = 4})
              .trajectory;
      const auto energy_J = [&](const Robot& robot) {
        return estimate_energy(make_plant(robot), motion).by_cause.total_J();
      };
      EXPECT_LT(std::abs(energy_J(file) - energy_J(truth)), kNormal95 * energy_sigma_J(file, motion))
          << set << speed_m_s;
    }
  }
  EXPECT_LT(squares, 37.7);  // chi squared of 3 times 5 constants: 0.1 %
}

}  // namespace
}  // namespace joulepath
