// Rows of runs without an effect: what they leave is noise, so their mean over many runs is what noise
// leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/checks/dead_channels.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/signals/log_set.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "diagnosis/where/gap.hpp"
#include "model/simulation/simulate.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kRunsOfARow = 200;

/// Speed (m/s) and yaw rate (rad/s) over time (s), as smooth as a plan's.
struct Drive {
  const char* name{};
  Twist<double> (*at)(double time_s){};
  double duration_s{};
  double payload_kg{};
};

double swell(double share) { return 0.5 * (1 - std::cos(2 * std::numbers::pi * share)); }

std::vector<Drive> drives() {
  return {{"there and back",
           [](double t) {
             const double swing = std::sin(2 * std::numbers::pi * t / 6);
             return Twist<double>{0.5 * swing * std::abs(swing), 0.0};
           },
           6, 0},
          {"loaded, straight and then round a bend",
           [](double t) {
             return Twist<double>{0.5 * swell(t / 3), t > 3 ? 0.9 * swell(t / 3) : 0.0};
           },
           6, 6}};
}

Trajectory reference_of(const Drive& drive) {
  Trajectory reference;
  for (int k = 0; 0.01 * k <= drive.duration_s; ++k) {
    const Twist<double> twist = drive.at(0.01 * k);
    reference.time_s.push_back(0.01 * k);
    reference.linear_speed_m_s.push_back(twist.speed_m_s);
    reference.angular_speed_rad_s.push_back(twist.yaw_rate_rad_s);
  }
  return reference;
}

/// The logs of one drive, which differ by the noise of the sensors alone.
std::vector<Run> logs_of(const Drive& drive, const Robot& robot, std::size_t count, std::uint64_t seed,
                         const std::vector<EffectSetting>& effects = {}) {
  std::vector<Run> runs(count);
  parallel_for(count, [&](std::size_t r) {
    const SimulationRequest request{.robot = robot,
                                    .effects = effects,
                                    .reference = reference_of(drive),
                                    .payload_kg = drive.payload_kg,
                                    .sensors = typical_sensors(),
                                    .seed = seed_of_run(seed, r)};
    runs[r] = {.name = drive.name,
               .log = simulate(request).log,
               .payload = {{0, drive.payload_kg}},
               .payload_known = true};
  });
  return runs;
}

/// Mean square of the rows' means over the runs, in sigmas of these means, per row of a channel; 0 without
/// rows.
Eigen::VectorXd chi_square_per_row(const std::vector<Run>& runs, const Robot& robot) {
  std::vector<ResidualRows> rows(runs.size());
  parallel_for(runs.size(), [&](std::size_t r) {
    const RunSignals signals = make_run_signals(runs[r], r, robot);
    rows[r] = residual_rows(signals, {.robot = robot}, predict(signals, {.robot = robot}));
  });
  Eigen::VectorXd result = Eigen::VectorXd::Zero(kChannelCount);
  for (int channel = 0; channel < kChannelCount; ++channel) {
    double counted = 0;
    for (Eigen::Index j = 0; j < rows.front().value.rows(); ++j) {
      double n = 0, sum = 0, squares = 0;
      for (const ResidualRows& run : rows) {
        if (!run.present(j, channel)) continue;
        const double value = run.value(j, channel);
        n += 1, sum += value, squares += value * value;
      }
      // A mean over the runs that happen to show the row is no mean of noise.
      if (n < 0.5 * static_cast<double>(rows.size())) continue;
      result[channel] += sum * sum / n / ((squares - sum * sum / n) / (n - 1));
      counted += 1;
    }
    if (counted > 0) result[channel] /= counted;
  }
  return result;
}

Run without_voltages(Run run) {
  for (Side side : kSides) run.log.motor_voltage_V[side].clear();
  return run;
}

Run without_motors(Run run) {
  for (Side side : kSides) run.log.motor_voltage_V[side].clear(), run.log.motor_current_A[side].clear();
  return run;
}

void expect_noise(const std::vector<Run>& runs, const Robot& robot, const std::string& what) {
  const Eigen::VectorXd found = chi_square_per_row(runs, robot);
  for (int channel = 0; channel < kChannelCount; ++channel)
    EXPECT_LT(found[channel], 2.0) << kChannelNames[static_cast<std::size_t>(channel)] << ", " << what;
  EXPECT_GT(found[kDriverPower], 0.0) << what;
}

class NullRows : public ::testing::TestWithParam<Drive> {};

TEST_P(NullRows, AreNoiseInEveryChannel) {
  const Robot robot = testing::nomad();
  auto runs = logs_of(GetParam(), robot, kRunsOfARow, 7);
  expect_noise(runs, robot, "all channels");
  const Eigen::VectorXd found = chi_square_per_row(runs, robot);
  for (const int channel : {kCurrentLeft, kCurrentRight, kWindingLeft, kWindingRight})
    EXPECT_GT(found[channel], 0.0) << "rows that count: " << kChannelNames[static_cast<std::size_t>(channel)];
  std::ranges::transform(runs, runs.begin(), without_motors);
  expect_noise(runs, robot, "battery alone");
}

/// A turn that scrubs, against a model that has the true moment: what is left is noise, on wide bends, where
/// a robot turns slowly, and while a turn on the spot begins and ends.
TEST(EffectRows, OfAScrubbingTurnAreNoise) {
  const std::vector<Drive> turns{{"wide bend",
                                  [](double t) {
                                    return Twist<double>{0.4 * swell(t / 6), 0.2 * swell(t / 6)};
                                  },
                                  6, 0},
                                 {"bend to the right",
                                  [](double t) {
                                    return Twist<double>{0.3 * swell(t / 6), -0.3 * swell(t / 6)};
                                  },
                                  6, 0},
                                 {"on the spot",
                                  [](double t) {
                                    return Twist<double>{0.0, 1.2 * swell(t / 4)};
                                  },
                                  4, 0}};
  for (const double moment_Nm : {0.15, 0.6})
    for (const Drive& drive : turns) {
      Robot robot = testing::nomad();
      const EffectSetting scrub{.name = "turning_scrub", .parameters = {{"moment_Nm", moment_Nm}}};
      const auto runs = logs_of(drive, robot, 40, 3, {scrub});
      robot.effects.push_back(scrub);
      const Eigen::VectorXd found = chi_square_per_row(runs, robot);
      for (const int channel : {kCurrentLeft, kCurrentRight})
        EXPECT_LT(found[channel], 2.0) << drive.name << ", " << moment_Nm << " N m, "
                                       << kChannelNames[static_cast<std::size_t>(channel)];
    }
}

/// 0 to 1 to 0 in `duration_s`, with steps of the acceleration at four times.
double ramp(double time_s, double duration_s) {
  return std::clamp(std::min(time_s, duration_s - time_s) / 0.4, 0.0, 1.0);
}

/// Motions whose accelerations jump, with rests between: as prescribed, and as a plan at its limits.
std::vector<Drive> drives_with_steps() {
  return {{"turns on the spot",
           [](double t) {
             const double part_s = std::fmod(t, 4);
             return Twist<double>{0, (t < 4 ? 0.8 : -0.8) * ramp(part_s - 0.5, 2.5)};
           },
           8, 0},
          {"straight",
           [](double t) {
             const double part_s = std::fmod(t, 4);
             return Twist<double>{(t < 4 ? 0.3 : -0.3) * ramp(part_s - 0.5, 2.5), 0};
           },
           8, 4}};
}

/// Measured and predicted energy of a perfect model, summed over all runs: relative difference.
double energy_bias(const std::vector<Run>& runs, const Robot& robot, EnergyAt at) {
  const Dataset day{.robot = robot, .runs = runs};
  LogSet logs{.dataset = &day};
  for (std::size_t r = 0; r < runs.size(); ++r) logs.runs.push_back(r);
  double measured_J = 0, predicted_J = 0;
  for (const RunEnergy& run :
       run_energies(read_signals(logs, 0), ModelPoints(runs.size(), {.robot = robot}), at))
    measured_J += run.measured_J, predicted_J += run.predicted_J;
  return predicted_J / measured_J - 1;
}

Robot recovering(PowerSharing sharing) {
  Robot robot = testing::nomad();
  robot.power.sharing = sharing;
  robot.power.regeneration_efficiency = 0.6;
  return robot;
}

/// A perfect model's energy is the measured one however the motors are driven: repeating a day averages noise
/// away, never a bias of the prediction.
TEST(NullEnergy, OfDrivesWhoseAccelerationJumpsHasNoBias) {
  for (const Robot& robot :
       {testing::nomad(), recovering(PowerSharing::bus), recovering(PowerSharing::wheel)})
    for (const Drive& drive : drives_with_steps()) {
      SCOPED_TRACE(std::string(drive.name) + (robot.power.sharing == PowerSharing::bus ? ", bus" : "") +
                   (robot.power.regeneration_efficiency > 0 ? ", recovers" : ""));
      auto runs = logs_of(drive, robot, 60, 17);
      EXPECT_NEAR(energy_bias(runs, robot, EnergyAt::motors_first), 0, 2e-3);
      EXPECT_NEAR(energy_bias(runs, robot, EnergyAt::battery), 0, 2e-3);
      std::ranges::transform(runs, runs.begin(), without_voltages);
      EXPECT_NEAR(energy_bias(runs, robot, EnergyAt::motors_first), 0, 2e-3) << "no voltage";
      std::ranges::transform(runs, runs.begin(), without_motors);
      EXPECT_NEAR(energy_bias(runs, robot, EnergyAt::battery), 0, 2e-3) << "battery alone";
    }
}

/// What the checks of channels expect of a battery is the mean of its power, where a wheel reverses, too.
TEST(FollowedChannel, OfASoundBatteryIsAllThatIsExpected) {
  for (const Drive& drive : drives())
    for (const joulepath::Run& run : logs_of(drive, testing::nomad(), 3, 21)) {
      const auto channels = followed_channels(make_run_signals(run, 0, testing::nomad()), testing::nomad());
      const auto battery = std::ranges::find(channels, std::vector<std::string>{"battery_current_A"},
                                             &FollowedChannel::columns);
      ASSERT_NE(battery, channels.end());
      EXPECT_NEAR(battery->followed, 1.0, 0.01) << drive.name;
    }
}

/// A day of both drives, each repeated.
Dataset day_of(std::uint64_t seed, const std::vector<EffectSetting>& effects = {}) {
  Dataset day{.robot = testing::nomad()};
  for (const Drive& drive : drives())
    for (joulepath::Run& run : logs_of(drive, day.robot, 8, ++seed, effects))
      day.runs.push_back(std::move(run));
  return day;
}

Diagnosis diagnosed_day(std::uint64_t seed, const std::vector<EffectSetting>& effects = {}) {
  return diagnose(day_of(seed, effects));
}

TEST(NullDay, OfDrivesThatRepeatHasNoGap) {
  for (const std::uint64_t seed : {100u}) {
    const Diagnosis answer = diagnosed_day(seed);
    EXPECT_EQ(answer.verdict, Verdict::no_gap);
    EXPECT_TRUE(answer.causes.empty());
  }
}

/// Without voltages and battery the motors' energy is that of the file's winding: currents that agree say
/// nothing of its resistance, however well they show other effects. A quarter more of it is no all-clear.
TEST(NullDay, IsNoneWhereOneEffectOfTheEnergyIsHidden) {
  Dataset day{.robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/tug_600kg.yaml")};
  for (const Drive& drive : drives())
    for (joulepath::Run& run :
         logs_of(drive, day.robot, 8, 7,
                 {{.name = "winding_resistance_error", .parameters = {{"fraction", 0.25}}}})) {
      run.log.motor_voltage_V = {}, run.log.motor_power_W = {};
      run.log.battery_voltage_V.clear(), run.log.battery_current_A.clear();
      day.runs.push_back(std::move(run));
    }
  const Diagnosis d = diagnose(day);
  EXPECT_EQ(d.verdict, Verdict::too_little_data) << verdict_name(d.verdict);
  EXPECT_TRUE(std::ranges::any_of(d.notes, [](const std::string& note) {
    return note.find(" of the energy by winding_resistance_error") != std::string::npos;
  }));
  EXPECT_LT(d.gap.energy.detectable_percent, kGreatestUnseen_percent) << "the others show";
  const auto& hard = d.gap.energy.hard_to_see;
  const auto winding = std::ranges::find(hard, "winding_resistance_error", &HardToSee::effect);
  ASSERT_NE(winding, hard.end());
  EXPECT_GT(winding->detectable_percent, kGreatestUnseen_percent);
}

/// Stamps the samples of a channel by a share of the sample time late.
void delay(std::vector<double>& channel, double share) {
  for (std::size_t i = channel.size(); i-- > 1;)
    channel[i] = (1 - share) * channel[i] + share * channel[i - 1];
}

/// A gyro that is stamped half a sample late changes no energy.
TEST(NullDay, OfALateGyroHasNoGap) {
  Dataset day = day_of(100);
  for (joulepath::Run& run : day.runs) delay(run.log.gyro_yaw_rate_rad_s, 0.5);
  EXPECT_EQ(diagnose(day).verdict, Verdict::no_gap);
}

Dataset with_late_motors(double share) {
  Dataset day = day_of(100);
  for (joulepath::Run& run : day.runs)
    for (const Side side : kSides)
      delay(run.log.motor_current_A[side], share), delay(run.log.motor_voltage_V[side], share);
  return day;
}

/// Whether a driver's stamp is at a sample's beginning, middle or end is no fault of the robot.
TEST(LateChannels, ByAPartOfASampleAreNoCause) {
  for (const double share : {0.15, 0.25, 0.4, 0.5}) {
    const Diagnosis answer = diagnose(with_late_motors(share));
    EXPECT_EQ(answer.verdict, Verdict::no_gap) << share << ' ' << verdict_name(answer.verdict);
    EXPECT_TRUE(answer.causes.empty()) << share;
  }
}

/// What explains the runs is likelier than not, from about a sample on a delay.
TEST(LateChannels, AreExplainedOnlyByALikelyCause) {
  for (const double share : {0.6, 0.8, 1.0}) {
    const Diagnosis answer = diagnose(with_late_motors(share));
    EXPECT_TRUE(share < 0.7 || answer.verdict == Verdict::explained) << share;
    if (answer.verdict != Verdict::explained) continue;
    ASSERT_FALSE(answer.causes.empty()) << share;
    EXPECT_EQ(answer.causes.front().effect.name, "time_misalignment") << share;
    EXPECT_GE(answer.causes.front().probability, kLeastProbabilityNamed) << share;
  }
}

/// Steps of 1.5 m/s^2, faster than a kernel resolves, are no slip of the wheels.
TEST(NullDay, OfAccelerationsThatJumpHasNoGap) {
  Dataset day{.robot = testing::nomad()};
  const std::vector<Drive> drives{{"steps",
                                   [](double t) {
                                     const double part_s = std::fmod(t, 3);
                                     return Twist<double>{(t < 3 ? 0.6 : -0.6) * ramp(part_s - 0.5, 2), 0};
                                   },
                                   6, 0},
                                  drives_with_steps().front()};
  for (const Drive& drive : drives)
    for (joulepath::Run& run : logs_of(drive, day.robot, 12, 41)) day.runs.push_back(std::move(run));
  const Diagnosis answer = diagnose(day);
  EXPECT_EQ(answer.verdict, Verdict::no_gap);
  EXPECT_TRUE(answer.causes.empty());
}

/// An effect far below what a user would notice, whose gap is that of noise, is listed at most.
TEST(NullDay, AnEffectBelowTheFloorIsNoVerdict) {
  const Diagnosis answer =
      diagnosed_day(300, {{.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.0015}}}});
  EXPECT_EQ(answer.verdict, Verdict::no_gap);
  EXPECT_TRUE(answer.causes.empty());
}

/// However sure an effect is, below the floor it is listed: nothing else is said to be unexplained for it.
TEST(NullDay, ASureEffectBelowTheFloorIsListedAndNothingStandsInForIt) {
  const auto effect = [](const char* name, const char* key, double value) {
    return EffectSetting{.name = name, .parameters = {{key, value}}};
  };
  for (const auto& [setting, robot_name] :
       {std::pair{effect("torque_constant_error", "fraction", 0.02), "husky_a200"},
        {effect("torque_constant_error", "fraction", 0.05), "husky_a200"},
        {effect("torque_constant_error", "fraction", -0.03), "tug_600kg"},
        {effect("winding_resistance_error", "fraction", 0.05), "husky_a200"}}) {
    Dataset day{
        .robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/" + std::string(robot_name) + ".yaml")};
    for (const Drive& drive : drives())
      for (joulepath::Run& run : logs_of(drive, day.robot, 8, 77, {setting}))
        day.runs.push_back(std::move(run));
    const Diagnosis answer = diagnose(day);
    const bool right = answer.verdict == Verdict::no_gap ||
                       (!answer.causes.empty() && answer.causes.front().effect.name == setting.name);
    EXPECT_TRUE(right) << setting.name << " " << robot_name << ": " << verdict_name(answer.verdict) << " "
                       << answer.leftover_description;
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, NullRows, ::testing::ValuesIn(drives()));

}  // namespace
}  // namespace joulepath
