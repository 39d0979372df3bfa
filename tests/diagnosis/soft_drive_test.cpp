// Wheels that are joined to the body by tyres and gears that yield: the body swings at 4 to 5 Hz behind
// rotors whose encoders the log reads. No constant of a robot file states it, and it takes no energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"
#include "model/dynamics.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

/// Mean with the weights of a bell of `width` samples.
std::vector<double> bell_smoothed(const std::vector<double>& values, double width) {
  const int reach = static_cast<int>(std::ceil(4 * width)), last = static_cast<int>(values.size()) - 1;
  std::vector<double> smooth(values.size());
  for (int i = 0; i <= last; ++i) {
    double sum = 0, weights = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = std::exp(-0.5 * k * k / (width * width));
      sum += weight * values[static_cast<std::size_t>(std::clamp(i + k, 0, last))];
      weights += weight;
    }
    smooth[static_cast<std::size_t>(i)] = sum / weights;
  }
  return smooth;
}

/// Derivatives of order 1, 2 and 3, at sample i.
struct Derivatives {
  double first{}, second{}, third{};
};

Derivatives derivatives(const std::vector<double>& x, std::size_t i, double step_s) {
  return {(x[i + 1] - x[i - 1]) / (2 * step_s), (x[i + 1] - 2 * x[i] + x[i - 1]) / (step_s * step_s),
          (x[i + 2] - 2 * x[i + 1] + 2 * x[i - 1] - x[i - 2]) / (2 * std::pow(step_s, 3))};
}

/// The same rotors with a body behind springs, along its way and in yaw: it moves as they do less the second
/// derivative of that motion over the frequency squared, to which the currents, the voltages on the windings,
/// the gyro and the pose add.
Dataset with_soft_drive(Dataset day, double frequency_rad_s) {
  const Robot& robot = day.robot;
  const double r = robot.geometry.wheel_radius_m.left, l = robot.geometry.half_track_m,
               soft_s2 = 1 / std::pow(frequency_rad_s, 2);
  for (joulepath::Run& run : day.runs) {
    Trajectory& log = run.log;
    const MassProperties mass = mass_properties(robot, run.payload.front().payload_kg);
    const double step_s = log.time_s[1] - log.time_s[0];
    const std::vector<double> left = bell_smoothed(log.wheel_speed_rad_s.left, 0.06 / step_s),
                              right = bell_smoothed(log.wheel_speed_rad_s.right, 0.06 / step_s);
    std::vector<double> speed, yaw_rate;
    for (std::size_t i = 0; i < left.size(); ++i)
      speed.push_back(0.5 * r * (right[i] + left[i])), yaw_rate.push_back(0.5 * r / l * (right[i] - left[i]));
    for (std::size_t i = 2; i + 2 < left.size(); ++i) {
      const Derivatives v = derivatives(speed, i, step_s), w = derivatives(yaw_rate, i, step_s);
      for (const Side side : kSides) {
        const double force_N =
            -0.5 * soft_s2 *
            (mass.mass_kg * v.third + (side == Side::right ? 1 : -1) * mass.yaw_inertia_kg_m2 / l * w.third);
        const double more_A = r * force_N / robot.motor[side].torque_per_ampere_Nm_A();
        log.motor_current_A[side][i] += more_A;
        log.motor_voltage_V[side][i] += robot.motor[side].resistance_ohm * more_A;
      }
      log.gyro_yaw_rate_rad_s[i] -= soft_s2 * w.second;
      log.heading_rad[i] -= soft_s2 * w.first;
      log.position_x_m[i] -= soft_s2 * v.first * std::cos(log.heading_rad[i]);
      log.position_y_m[i] -= soft_s2 * v.first * std::sin(log.heading_rad[i]);
    }
  }
  return day;
}

TEST(SoftDrive, IsNoGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* robot : {"warehouse", "tug"})
    for (const double frequency_rad_s : {25.0, 35.0}) {
      const Dataset day = testing::blind_day(std::string("--effect none --level 0 --protocol 24 --seed 2") +
                                             " --robot " + robot);
      const Diagnosis d = diagnose(with_soft_drive(day, frequency_rad_s), {.bootstrap = 0});
      EXPECT_EQ(d.verdict, Verdict::no_gap)
          << verdict_name(d.verdict) << ", " << robot << ", " << frequency_rad_s;
    }
}

}  // namespace
}  // namespace joulepath
