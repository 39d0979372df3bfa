// Entries of the dictionary against their formulas.
#include "diagnosis/prediction/dictionary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/signals/friction_direction.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// A drive forward and one in reverse with turns, so that speeds and currents have both signs.
RunSignals there_or_back(double speed_m_s) {
  const Run run =
      testing::synthetic_run(testing::nomad(), "run", 10, 2.0, testing::swinging(speed_m_s, 0.2, 1.3, 0.6));
  return make_run_signals(run, 0, testing::nomad());
}

/// Rows of the entries of a family and channel, one column per entry.
std::vector<Eigen::VectorXd> entries_of(const RunSignals& run, const std::string& family,
                                        const std::string& of, Channel channel) {
  const Robot robot = testing::nomad();
  const DictionaryLayout layout = lay_out({run}, robot);
  const std::vector<DictionaryEntry> names = dictionary_entries(layout);
  const std::vector<Eigen::MatrixXd> rows =
      dictionary_rows(layout, run, robot, predict(run, {.robot = robot}));
  EXPECT_EQ(names.size(), rows.size());
  std::vector<Eigen::VectorXd> found;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (names[k].family == family && names[k].channel == of) found.push_back(rows[k].col(channel));
  return found;
}

class DictionaryEntries : public ::testing::TestWithParam<double> {};

TEST_P(DictionaryEntries, SupplyPowerDependsOnTheSizeOfCurrentsAndSpeeds) {
  const RunSignals run = there_or_back(GetParam());
  const Prediction p = predict(run, {.robot = testing::nomad()});
  const auto current = entries_of(run, "current", "battery power", kDriverPower);
  const auto speed = entries_of(run, "wheel speed", "battery power", kDriverPower);
  const auto power = entries_of(run, "motor power", "battery power", kDriverPower);
  ASSERT_TRUE(current.size() == 2 && speed.size() == 1 && power.size() == 2);
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const double left_A = p.current_A.left[j], right_A = p.current_A.right[j];
    EXPECT_NEAR(current[0][j], std::abs(left_A) + std::abs(right_A), 1e-12);
    EXPECT_NEAR(current[1][j], left_A * left_A + right_A * right_A, 1e-12);
    EXPECT_NEAR(speed[0][j],
                std::abs(run.wheel_speed_rad_s.left[j]) + std::abs(run.wheel_speed_rad_s.right[j]), 1e-12);
    const double sum_W = p.power_W.left[j] + p.power_W.right[j];
    EXPECT_NEAR(power[0][j] + power[1][j], sum_W, 1e-12);
    EXPECT_GE(power[0][j], 0.0);
    EXPECT_LE(power[1][j], 0.0);
  }
}

TEST_P(DictionaryEntries, VoltageOfAWindingIsOddInSpeed) {
  const RunSignals run = there_or_back(GetParam());
  const auto speed = entries_of(run, "wheel speed", "voltage", kWindingLeft);
  ASSERT_EQ(speed.size(), 3u);
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const double q = run.wheel_speed_rad_s.left[j];
    EXPECT_NEAR(speed[0][j], q, 1e-12);
    EXPECT_NEAR(speed[2][j], std::copysign(q * q, q), 1e-12);
  }
}

/// What becomes of the power of a wheel that brakes.
struct Supply {
  double regeneration{};
  PowerSharing sharing{};
};

/// c phi(P/c), where an effect changes c by a watt or by its own size.
double doubt_of_sign_W(double power_W, double change_W) {
  const double z = power_W / std::max(change_W, 1e-6);
  return (1 + change_W) * std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

class ReadingOfACurrent : public ::testing::TestWithParam<Supply> {};

/// The dictionary's rows of a sensor that reads too much are those of the catalog's effects.
TEST_P(ReadingOfACurrent, ShowsWhereverTheCurrentIsUsed) {
  Robot robot = testing::nomad();
  robot.power.regeneration_efficiency = GetParam().regeneration;
  robot.power.sharing = GetParam().sharing;
  const joulepath::Run log =
      testing::synthetic_run(robot, "run", 10, 2.0, testing::swinging(0.1, 0.5, 3.0, 1.5));
  const RunSignals run = make_run_signals(log, 0, robot);
  const ModelPoint nominal{.robot = robot};
  const Prediction base = predict(run, nominal);
  const std::vector<DictionaryEntry> names = dictionary_entries(lay_out({run}, robot));
  const std::vector<Eigen::MatrixXd> rows = dictionary_rows(lay_out({run}, robot), run, robot, base);
  constexpr double kOffset_A = 1e-4, kGain = 1e-4;
  const auto of_the_catalog = [&](const EffectSetting& effect, double size) -> Eigen::MatrixXd {
    return signature_rows(run, nominal, base, predict(run, {.robot = robot, .effects = {effect}})) / size;
  };
  const Eigen::MatrixXd offset = of_the_catalog(
      {.name = "current_sensor_offset", .parameters = {{"offset_A", kOffset_A}}, .side = Side::left},
      kOffset_A);
  const Eigen::MatrixXd gain =
      of_the_catalog({.name = "current_sensor_gain", .parameters = {{"fraction", kGain}}}, kGain);
  const auto rows_of = [&](const std::string& curve) -> const Eigen::MatrixXd& {
    return rows[static_cast<std::size_t>(std::ranges::find(names, curve, &DictionaryEntry::curve) -
                                         names.begin())];
  };
  const Eigen::MatrixXd &constant = rows_of("shifted reading"), &scaled = rows_of("scaled reading");
  int braking = 0;
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const double left_W = base.power_W.left[j], right_W = base.power_W.right[j];
    // Where the sign may change within the kernel, the catalog's effect changes by how much, too.
    const double left_change_W = std::abs(base.power_change_W.left[j]),
                 right_change_W = std::abs(base.power_change_W.right[j]);
    const double doubt_W = doubt_of_sign_W(left_W, left_change_W) + doubt_of_sign_W(right_W, right_change_W) +
                           doubt_of_sign_W(left_W + right_W, left_change_W + right_change_W);
    if (doubt_W > 0.5) continue;
    braking += left_W < 0;
    for (const Channel channel : {kCurrentLeft, kCurrentRight, kWindingLeft, kWindingRight, kDriverPower}) {
      EXPECT_NEAR(constant(j, channel), offset(j, channel), 1e-5 + 2 * doubt_W) << j << " channel " << channel;
      EXPECT_NEAR(scaled(j, channel), gain(j, channel), 1e-5 + 2 * doubt_W) << j << " channel " << channel;
    }
  }
  EXPECT_GT(braking, 5);
}

INSTANTIATE_TEST_SUITE_P(Supplies, ReadingOfACurrent,
                         ::testing::Values(Supply{0.0, PowerSharing::wheel}, Supply{0.6, PowerSharing::wheel},
                                           Supply{0.4, PowerSharing::bus}));

/// A gear takes its part of the torque, against the motion.
TEST_P(DictionaryEntries, LossOfAGearFollowsTheMotorsTorque) {
  const RunSignals run = there_or_back(GetParam());
  const Prediction p = predict(run, {.robot = testing::nomad()});
  const auto torque = entries_of(run, "motor torque", "current", kCurrentRight);
  ASSERT_EQ(torque.size(), 1u);
  for (Eigen::Index j = 0; j < run.size(); ++j)
    EXPECT_NEAR(torque[0][j],
                std::abs(p.current_A.right[j]) * friction_direction(run.wheel_speed_rad_s.right[j]), 1e-12);
}

TEST(ReadingOfOneCurrent, NeedsASensor) {
  const Robot robot = testing::nomad();
  joulepath::Run log = testing::synthetic_run(robot, "run", 10, 2.0, testing::swinging(0.5, 0.2, 1.3, 0.6));
  log.log.motor_current_A.right.clear();
  const RunSignals run = make_run_signals(log, 0, robot);
  for (const Channel channel : {kCurrentLeft, kCurrentRight, kWindingLeft, kWindingRight}) {
    const auto entries = entries_of(run, "constant", "current reading", channel);
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0].isZero(), channel != kCurrentLeft && channel != kWindingLeft) << channel;
    EXPECT_TRUE(entries[1].isZero()) << channel;
  }
}

/// A force F along the heading asks r F/2 of each wheel; a moment M asks -/+ r M/(2 l). Both are over Kt n.
TEST_P(DictionaryEntries, ForceAndMomentAreSharedByTheWheels) {
  const RunSignals run = there_or_back(GetParam());
  const Robot robot = testing::nomad();
  const double r = robot.geometry.wheel_radius_m.left, l = robot.geometry.half_track_m,
               k = robot.motor.left.torque_per_ampere_Nm_A();
  const auto left = entries_of(run, "speed", "current", kCurrentLeft),
             right = entries_of(run, "speed", "current", kCurrentRight),
             turn_left = entries_of(run, "yaw acceleration", "current", kCurrentLeft),
             turn_right = entries_of(run, "yaw acceleration", "current", kCurrentRight);
  ASSERT_TRUE(left.size() == 2 && right.size() == 2 && turn_left.size() == 1 && turn_right.size() == 1);
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const double v = r * (run.wheel_speed_rad_s.left[j] + run.wheel_speed_rad_s.right[j]) / 2;
    EXPECT_NEAR(left[0][j], 0.5 * r * v / k, 1e-12);
    EXPECT_NEAR(right[1][j], 0.5 * r * std::copysign(v * v, v) / k, 1e-12);
    const double yaw_rad_s2 =
        r * (run.wheel_acceleration_rad_s2.right[j] - run.wheel_acceleration_rad_s2.left[j]) / (2 * l);
    EXPECT_NEAR(turn_right[0][j], r * yaw_rad_s2 / (2 * l * k), 1e-12);
    EXPECT_NEAR(turn_left[0][j], -turn_right[0][j], 1e-12);
  }
}

/// A speed that the wheels do not show moves the robot along its heading; poses count from their mean.
TEST_P(DictionaryEntries, MissedSpeedAddsUpAlongTheHeading) {
  const RunSignals run = there_or_back(GetParam());
  const double r = testing::nomad().geometry.wheel_radius_m.left;
  const auto x = entries_of(run, "speed", "motion", kPositionX),
             y = entries_of(run, "speed", "motion", kPositionY),
             heading = entries_of(run, "speed", "motion", kHeading),
             gyro = entries_of(run, "speed", "motion", kGyro);
  ASSERT_EQ(x.size(), 3u);
  for (Eigen::Index j = 1; j < run.size(); ++j) {
    const double v = r * (run.wheel_speed_rad_s.left[j] + run.wheel_speed_rad_s.right[j]) / 2;
    EXPECT_NEAR(x[0][j] - x[0][j - 1], v * std::cos(run.heading_rad[j]) * run.period_s, 1e-12);
    EXPECT_NEAR(y[0][j] - y[0][j - 1], v * std::sin(run.heading_rad[j]) * run.period_s, 1e-12);
    EXPECT_NEAR(y[1][j] - y[1][j - 1], std::abs(v) * (y[0][j] - y[0][j - 1]), 1e-12);
    EXPECT_EQ(gyro[0][j], 0.0);
    EXPECT_NEAR(gyro[2][j], v, 1e-12) << "a yaw rate in proportion to the speed";
    EXPECT_NEAR(heading[2][j] - heading[2][j - 1], v * run.period_s, 1e-12);
  }
  EXPECT_NEAR(x[0].mean(), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Forward, DictionaryEntries, ::testing::Values(0.5));
INSTANTIATE_TEST_SUITE_P(Reverse, DictionaryEntries, ::testing::Values(-0.5));

/// A turn to the right is the mirror image of one to the left.
TEST(DictionaryOfTurns, IsTheMirrorImageToTheOtherSide) {
  const auto turning = [](double turn_rad_s) {
    const auto run = testing::synthetic_run(testing::nomad(), "run", 10, 2.0,
                                            testing::swinging(0.5, 0.2, 1.3, turn_rad_s));
    return make_run_signals(run, 0, testing::nomad());
  };
  const RunSignals to_left = turning(0.6), to_right = turning(-0.6);
  const auto left = entries_of(to_left, "yaw rate", "current", kCurrentLeft),
             right = entries_of(to_right, "yaw rate", "current", kCurrentRight);
  ASSERT_GT(left.size(), 1u);
  ASSERT_EQ(left.size(), right.size());
  double most = 0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    EXPECT_LT((left[k] - right[k]).cwiseAbs().maxCoeff(), 1e-9) << k;
    most = std::max(most, left[k].cwiseAbs().maxCoeff());
  }
  EXPECT_GT(most, 1e-3);
}

}  // namespace
}  // namespace joulepath
