#include "diagnosis/checks/data_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/checks/motor_notes.hpp"
#include "diagnosis/checks/noisy_units.hpp"
#include "diagnosis/checks/pose_notes.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/log_columns.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

/// A test day of the benchmark's plant, which shares no code with the product.
Dataset twelve_runs(const std::string& options) {
  return testing::blind_day(options + " --protocol 12 --label none");
}

/// The run with the most turning to both sides: the motors work differently there, so every channel carries
/// information.
std::size_t liveliest(const Dataset& dataset) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r) {
    const Sided<std::vector<double>>& wheels = dataset.runs[r].log.wheel_speed_rad_s;
    double turned = 0, to_one_side = 0;
    for (std::size_t i = 0; i < wheels.left.size(); ++i) {
      turned += std::abs(wheels.right[i] - wheels.left[i]);
      to_one_side += wheels.right[i] - wheels.left[i];
    }
    if (turned - std::abs(to_one_side) > most) most = turned - std::abs(to_one_side), best = r;
  }
  return best;
}

using Spoil = std::function<void(Trajectory&)>;

void scale(std::vector<double>& channel, double factor) {
  for (double& value : channel) value *= factor;
}

struct Case {
  const char* name;
  const char* kind;
  const char* channel;  ///< the channel that the check must name
  Spoil spoil;
};

std::vector<Case> cases() {
  constexpr double kDegrees = 180 / std::numbers::pi;
  return {
      {"CurrentInverted", "inverted", "motor_current_right_A",
       [](Trajectory& t) { scale(t.motor_current_A.right, -1); }},
      {"CurrentsInverted", "inverted", "motor_current_left_A",
       [](Trajectory& t) { scale(t.motor_current_A.left, -1), scale(t.motor_current_A.right, -1); }},
      {"VoltageInverted", "inverted", "motor_voltage_left_V",
       [](Trajectory& t) { scale(t.motor_voltage_V.left, -1); }},
      {"WheelSpeedInverted", "inverted", "wheel_speed_left_rad_s",
       [](Trajectory& t) { scale(t.wheel_speed_rad_s.left, -1); }},
      {"GyroInverted", "inverted", "gyro_yaw_rate_rad_s",
       [](Trajectory& t) { scale(t.gyro_yaw_rate_rad_s, -1); }},
      {"CurrentsSwapped", "swapped", "motor_current_left_A",
       [](Trajectory& t) { std::swap(t.motor_current_A.left, t.motor_current_A.right); }},
      {"WheelSpeedsSwapped", "swapped", "wheel_speed_left_rad_s",
       [](Trajectory& t) { std::swap(t.wheel_speed_rad_s.left, t.wheel_speed_rad_s.right); }},
      {"CurrentDead", "dead", "motor_current_right_A",
       [](Trajectory& t) { scale(t.motor_current_A.right, 0); }},
      {"CurrentInMilliamperes", "unit", "motor_current_left_A",
       [](Trajectory& t) { scale(t.motor_current_A.left, 1e3); }},
      {"VoltageInMillivolts", "unit", "motor_voltage_left_V",
       [](Trajectory& t) { scale(t.motor_voltage_V.left, 1e3); }},
      {"WheelSpeedsInRpm", "unit", "wheel_speed_left_rad_s",
       [](Trajectory& t) {
         scale(t.wheel_speed_rad_s.left, 30 / std::numbers::pi),
             scale(t.wheel_speed_rad_s.right, 30 / std::numbers::pi);
       }},
      {"HeadingInDegrees", "unit", "heading_rad", [](Trajectory& t) { scale(t.heading_rad, kDegrees); }},
      {"ClockInMilliseconds", "clock", "time_s", [](Trajectory& t) { scale(t.time_s, 1e3); }},
      {"BatteryCurrentInverted", "inverted", "battery_current_A",
       [](Trajectory& t) { scale(t.battery_current_A, -1); }},
      {"CurrentStuck", "dead", "motor_current_left_A",
       [](Trajectory& t) { std::ranges::fill(t.motor_current_A.left, 0.7); }},
      {"CurrentStuckAtZero", "dead", "motor_current_left_A",
       [](Trajectory& t) { std::ranges::fill(t.motor_current_A.left, 0.0); }},
      {"VoltageStuck", "dead", "motor_voltage_left_V",
       [](Trajectory& t) { std::ranges::fill(t.motor_voltage_V.left, 7.0); }},
      {"BatteryCurrentInMilliamperes", "unit", "battery_current_A",
       [](Trajectory& t) { scale(t.battery_current_A, 1e3); }},
      {"BatteryVoltageInMillivolts", "unit", "battery_voltage_V",
       [](Trajectory& t) { scale(t.battery_voltage_V, 1e3); }},
      {"GyroDead", "dead", "gyro_yaw_rate_rad_s", [](Trajectory& t) { scale(t.gyro_yaw_rate_rad_s, 0); }},
      {"CurrentsTimesThree", "scaled", "motor_current_left_A",
       [](Trajectory& t) { scale(t.motor_current_A.left, 3), scale(t.motor_current_A.right, 3); }},
      {"CurrentTimesThreeTenths", "scaled", "motor_current_right_A",
       [](Trajectory& t) { scale(t.motor_current_A.right, 0.3); }},
  };
}

/// Whether repairs give the sound channels back, but for a few percent of a factor that is estimated.
void expect_mended(const Run& spoilt, const std::vector<ColumnRepair>& repairs, const Run& sound,
                   const Geometry& geometry) {
  const Run mended = repaired(spoilt, repairs, geometry);
  for (const ColumnRepair& repair : repairs) {
    if (repair.absent) continue;
    const LogColumn& column = *find_log_column(repair.column);
    const std::vector<double>&is = column.of(mended.log), &was = column.of(sound.log);
    for (std::size_t i = 0; i < was.size(); ++i)
      ASSERT_NEAR(is[i], was[i], 0.03 * std::abs(was[i]) + 1e-12) << repair.column << " of row " << i;
  }
}

class SpoiltChannel : public ::testing::TestWithParam<Case> {
 protected:
  static const Dataset& day() {
    static const Dataset dataset = twelve_runs("--effect none --seed 71");
    return dataset;
  }
};

TEST_P(SpoiltChannel, OfOneRunIsNamedWithItsRun) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = day();
  const std::size_t spoilt = liveliest(dataset);
  GetParam().spoil(dataset.runs[spoilt].log);
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, GetParam().kind) << found[0].evidence;
  EXPECT_NE(found[0].channel.find(GetParam().channel), std::string::npos) << found[0].channel;
  EXPECT_EQ(found[0].run, dataset.runs[spoilt].name);
  expect_mended(dataset.runs[spoilt], found[0].columns, day().runs[spoilt], dataset.robot.geometry);
}

TEST_P(SpoiltChannel, OfAllRunsIsNamedAndStopsTheDiagnosis) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = day();
  for (auto& run : dataset.runs) GetParam().spoil(run.log);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::data_suspect) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
  ASSERT_FALSE(d.data_checks.empty());
  EXPECT_EQ(d.data_checks[0].run, "") << "a fault of all runs";
  EXPECT_EQ(d.data_checks[0].kind, GetParam().kind) << d.data_checks[0].evidence;
  EXPECT_NE(d.data_checks[0].channel.find(GetParam().channel), std::string::npos) << d.data_checks[0].channel;
}

INSTANTIATE_TEST_SUITE_P(DataChecks, SpoiltChannel, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Spoils each run in turn. Returns how many are named, each alone and with its run.
std::size_t named_whichever(const Spoil& spoil, const char* kind, const char* channel) {
  const Dataset sound = twelve_runs("--effect none --seed 71");
  std::size_t named = 0;
  for (std::size_t r = 0; r < sound.runs.size(); ++r) {
    Dataset dataset = sound;
    spoil(dataset.runs[r].log);
    const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
    if (found.empty()) continue;
    ++named;
    EXPECT_EQ(found.size(), 1u) << sound.runs[r].name;
    EXPECT_EQ(found[0].kind, kind);
    EXPECT_EQ(found[0].channel, channel);
    EXPECT_EQ(found[0].run, sound.runs[r].name);
  }
  return named;
}

/// Counts of encoders instead of speeds ask every other channel for a change that none shows: the counts are
/// wrong, not the others.
TEST(EncoderCounts, AsSpeedsMakeNoOtherChannelDead) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = twelve_runs("--effect none --seed 71");
  for (joulepath::Run& run : dataset.runs)
    for (const Side side : kSides) {
      double angle_rad = 0;
      std::vector<double>& speed = run.log.wheel_speed_rad_s[side];
      for (std::size_t i = 1; i < speed.size(); ++i) {
        angle_rad += speed[i] * (run.log.time_s[i] - run.log.time_s[i - 1]);
        speed[i] = std::round(angle_rad * 2000 * 24.9 / (2 * std::numbers::pi));
      }
    }
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  EXPECT_FALSE(found.empty());
  for (const DataCheck& check : found) EXPECT_NE(check.kind, "dead") << check.run << " " << check.channel;
}

TEST(MotorNotes, OfUnsignedCurrentsAndOfAnotherClockAndOfNothingElse) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* sound : {"none", "time_misalignment --size 0.12", "floor_slope --size 0.02"})
    EXPECT_TRUE(motor_notes(twelve_runs(std::string("--effect ") + sound + " --seed 71")).empty()) << sound;
  Dataset magnitudes = twelve_runs("--effect none --seed 71"), late = magnitudes;
  for (joulepath::Run& run : magnitudes.runs)
    for (double& current_A : run.log.motor_current_A.left) current_A = std::abs(current_A);
  ASSERT_EQ(motor_notes(magnitudes).size(), 1u);
  EXPECT_NE(motor_notes(magnitudes)[0].find("motor_current_left_A: {unsigned: true}"), std::string::npos);
  for (joulepath::Run& run : late.runs) {
    std::vector<double>& voltage = run.log.motor_voltage_V.right;
    const auto rows = static_cast<std::ptrdiff_t>(std::lround(
        2.0 * static_cast<double>(run.log.size()) / (run.log.time_s.back() - run.log.time_s.front())));
    std::rotate(voltage.begin(), voltage.end() - rows, voltage.end());
    std::fill(voltage.begin(), voltage.begin() + rows, 0.0);
  }
  ASSERT_EQ(motor_notes(late).size(), 1u);
  EXPECT_NE(motor_notes(late)[0].find("motor_voltage_right_V follows its wheel about 1.8 s late"),
            std::string::npos)
      << motor_notes(late)[0];
}

/// The voltage of a heavy robot leads its speed, and is as much like that of the drive before it.
TEST(MotorNotes, OfEqualDrivesAreNone) {
  joulepath::Run run{.name = "four drives"};
  for (int i = 0; i < 400; ++i) {
    const double t = 0.04 * i, phase = std::fmod(t, 4.0), peak = 4.0;
    const double acceleration = phase < 1.6   ? peak / 1.6
                                : phase < 3.2 ? -peak / 1.6
                                              : 0.0,
                 speed = phase < 1.6   ? acceleration * phase
                         : phase < 3.2 ? peak * (3.2 - phase) / 1.6
                                       : 0.0;
    run.log.time_s.push_back(t);
    for (const Side side : kSides) {
      run.log.wheel_speed_rad_s[side].push_back(speed);
      run.log.motor_voltage_V[side].push_back(2 * speed + 0.8 * acceleration);
    }
  }
  Dataset dataset;
  dataset.runs = {run};
  const std::vector<std::string> notes = motor_notes(dataset);
  EXPECT_TRUE(notes.empty()) << notes.front();
}

/// The pose that the wheels' speeds add up to; `start`: the share of the speed at the start of each step, the
/// rest is that at its end.
void replace_by_odometry(joulepath::Run& run, const Geometry& geometry, double start) {
  Trajectory& log = run.log;
  const auto& [left, right] = log.wheel_speed_rad_s;
  for (std::size_t i = 1; i < log.size(); ++i) {
    const double step_s = log.time_s[i] - log.time_s[i - 1];
    const double to_left = geometry.wheel_radius_m.left * std::lerp(left[i], left[i - 1], start) * step_s,
                 to_right = geometry.wheel_radius_m.right * std::lerp(right[i], right[i - 1], start) * step_s;
    const double turned = (to_right - to_left) / (2 * geometry.half_track_m);
    const double along = log.heading_rad[i - 1] + 0.5 * turned;
    log.heading_rad[i] = log.heading_rad[i - 1] + turned;
    log.position_x_m[i] = log.position_x_m[i - 1] + 0.5 * (to_left + to_right) * std::cos(along);
    log.position_y_m[i] = log.position_y_m[i - 1] + 0.5 * (to_left + to_right) * std::sin(along);
  }
}

/// A drive of 24 s with noise on its wheels' speeds; its pose is their odometry.
Dataset noisy_drive() {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  Dataset day{.robot = testing::nomad()};
  Trajectory& log = day.runs.emplace_back(joulepath::Run{.name = "noisy"}).log;
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.02 * i;
    log.time_s.push_back(t);
    log.wheel_speed_rad_s.left.push_back(5 + std::sin(0.6 * t) + noise(random));
    log.wheel_speed_rad_s.right.push_back(5 + 2 * std::sin(0.4 * t) + noise(random));
  }
  for (auto* channel : {&log.position_x_m, &log.position_y_m, &log.heading_rad})
    channel->assign(log.size(), 0.0);
  replace_by_odometry(day.runs[0], day.robot.geometry, 0.5);
  return day;
}

TEST(PoseNotes, NameTheChannelsThatAreOdometry) {
  const Dataset odometry = noisy_drive();
  const auto note_on = [](const Dataset& day) {
    const std::vector<std::string> notes = pose_notes(day);
    return notes.size() == 1 ? notes[0].substr(0, notes[0].find(" the noise of the wheels")) : std::string();
  };
  EXPECT_EQ(note_on(odometry), "noisy: position_x_m, position_y_m and heading_rad repeat");
  Dataset only_heading = odometry;
  only_heading.runs[0].log.position_x_m.clear();
  EXPECT_EQ(note_on(only_heading), "noisy: heading_rad repeats");
  Dataset with_a_gyro = odometry;
  for (std::size_t i = 0; i < odometry.runs[0].log.size(); ++i)  // a gyro's heading differs by its noise
    with_a_gyro.runs[0].log.heading_rad[i] += 0.01 * ((i * 7919) % 13 / 6.0 - 1);
  EXPECT_EQ(note_on(with_a_gyro), "noisy: position_x_m and position_y_m repeat");
  Dataset lost_once = odometry;
  lost_once.runs[0].log.heading_rad[600] = std::nan("");
  EXPECT_EQ(note_on(lost_once), note_on(odometry));
}

/// A firmware may sum up the wheels with constants of its own.
TEST(PoseNotes, OfOdometryWithOtherConstants) {
  for (const double share : {0.9, 0.97, 1.05}) {
    Dataset day = noisy_drive();
    Geometry of_firmware = day.robot.geometry;
    for (const Side side : kSides) of_firmware.wheel_radius_m[side] *= share;
    replace_by_odometry(day.runs[0], of_firmware, 0.5);
    EXPECT_EQ(pose_notes(day).size(), 1u) << share;
  }
}

/// A filter leans on the wheels from step to step, and on a localization over the way: it shows that the
/// wheels are smaller than the file says.
TEST(PoseNotes, NotOfAPoseThatALocalizationCorrects) {
  Dataset day = noisy_drive();
  joulepath::Run& run = day.runs[0];
  Geometry true_wheels = day.robot.geometry;
  for (const Side side : kSides) true_wheels.wheel_radius_m[side] *= 0.95;
  joulepath::Run odometry = run, truth = run;
  replace_by_odometry(truth, true_wheels, 0.5);
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0.0, 0.002);
  for (auto channel : {&Trajectory::position_x_m, &Trajectory::position_y_m, &Trajectory::heading_rad}) {
    std::vector<double>& pose = run.log.*channel;
    const std::vector<double>&step = odometry.log.*channel, &true_pose = truth.log.*channel;
    for (std::size_t i = 1; i < pose.size(); ++i) {
      const double predicted = pose[i - 1] + step[i] - step[i - 1];
      pose[i] = predicted + 0.02 * (true_pose[i] + noise(random) - predicted);
    }
  }
  EXPECT_TRUE(pose_notes(day).empty()) << pose_notes(day)[0];
}

TEST(PoseNotes, OfOdometryAndOfNothingElse) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* sound : {"none", "wheel_slip --size 0.02", "time_misalignment --size 0.12"})
    EXPECT_TRUE(pose_notes(twelve_runs(std::string("--effect ") + sound + " --seed 71")).empty()) << sound;
  const Dataset day = twelve_runs("--effect none --seed 71");
  for (const double start : {0.0, 0.5, 1.0}) {
    Dataset odometry = day;
    replace_by_odometry(odometry.runs[3], day.robot.geometry, start);
    const std::vector<std::string> notes = pose_notes(odometry);
    ASSERT_EQ(notes.size(), 1u) << start;
    EXPECT_NE(notes[0].find(day.runs[3].name + ": position_x_m, position_y_m and heading_rad"),
              std::string::npos)
        << notes[0];
  }
}

/// No run may hide a wrong current behind the freedom that its own laws have: the other runs take it away.
/// Slow runs need so little power that their batteries do not tell.
TEST(OddRun, WithAWrongCurrentIsNamedWhicheverItIs) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  EXPECT_GE(named_whichever([](Trajectory& t) { scale(t.motor_current_A.right, 0.3); }, "scaled",
                            "motor_current_right_A"),
            10u);
}

/// A gyro without even noise is dead, also where the robot drives straight; but for the run whose wheels
/// differ least: no run with less motion shows noise.
TEST(OddRun, WithADeadGyroIsNamedWhicheverItIs) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  EXPECT_GE(
      named_whichever([](Trajectory& t) { scale(t.gyro_yaw_rate_rad_s, 0); }, "dead", "gyro_yaw_rate_rad_s"),
      11u);
}

/// On a straight drive the gyro reads noise and a bias, which no motion tells from a turn.
TEST(NoisyUnit, OfAGyroOnAStraightDriveIsNamed) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = twelve_runs("--effect none --seed 71");
  const auto turned = [](const joulepath::Run& run) {
    double sum = 0;
    for (double rate_rad_s : run.log.gyro_yaw_rate_rad_s) sum += std::abs(rate_rad_s);
    return sum / static_cast<double>(run.log.size());
  };
  const auto straight = std::ranges::min_element(dataset.runs, {}, turned);
  scale(straight->log.gyro_yaw_rate_rad_s, 180 / std::numbers::pi);
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, "unit");
  EXPECT_EQ(found[0].channel, "gyro_yaw_rate_rad_s");
  EXPECT_EQ(found[0].run, straight->name);
  EXPECT_NEAR(found[0].columns.at(0).scale, std::numbers::pi / 180, 1e-12);
}

/// A position that scatters by metres while the robot spins is in mm.
TEST(NoisyUnit, OfAPositionOnTheSpotIsNamed) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = twelve_runs("--effect none --seed 71");
  const auto reach = [](const joulepath::Run& run) {
    return std::abs(std::ranges::max(run.log.position_x_m));
  };
  const auto spin = std::ranges::min_element(dataset.runs, {}, reach);
  scale(spin->log.position_x_m, 1e3), scale(spin->log.position_y_m, 1e3);
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, "unit");
  EXPECT_EQ(found[0].channel, "position_x_m, position_y_m");
  EXPECT_EQ(found[0].run, spin->name);
}

/// Set points that hold for some seconds each, with transitions of 1.2 s.
class SmoothDrive {
 public:
  SmoothDrive(std::mt19937& random, double least, double most, double hold_s) {
    std::uniform_real_distribution<double> level(least, most), hold(0.5 * hold_s, 1.5 * hold_s);
    for (double t = hold(random); t < 200; t += hold(random)) {
      starts_s_.push_back(t);
      levels_.push_back(level(random));
    }
  }

  double at(double time_s) const {
    double value = levels_[0];
    for (std::size_t k = 1; k < levels_.size() && starts_s_[k] < time_s; ++k) {
      const double share = std::min(1.0, (time_s - starts_s_[k]) / 1.2);
      value += (levels_[k] - levels_[k - 1]) * 0.5 * (1 - std::cos(std::numbers::pi * share));
    }
    return value;
  }

 private:
  std::vector<double> starts_s_{}, levels_{};
};

double six_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::strtod(text, nullptr);
}

/// A simulator's logs without noise: eight runs of a weaving, turning or straight robot, as a CSV holds them.
Dataset noise_free_day(int seed, double rate_Hz, bool motors) {
  std::mt19937 random(static_cast<unsigned>(seed));
  Dataset day{.robot = testing::nomad()};
  const Geometry& geometry = day.robot.geometry;
  for (int r = 0; r < 8; ++r) {
    const bool straight = random() % 3 == 0;
    const double hold_s = straight ? 60 : 1.5 + static_cast<double>(random() % 4);
    const SmoothDrive speed(random, 0.2, 0.6, hold_s),
        yaw(random, straight ? 0 : -0.5, straight ? 0 : 0.5, hold_s);
    Trajectory& log = day.runs.emplace_back(joulepath::Run{.name = "run " + std::to_string(r)}).log;
    double x_m = 0, y_m = 0, heading_rad = 0;
    const double step_s = 1 / rate_Hz;
    for (int i = 0; i < std::max(60, static_cast<int>(40 * rate_Hz)); ++i) {
      const double t = i * step_s, v = speed.at(t), w = yaw.at(t);
      log.time_s.push_back(t);
      log.gyro_yaw_rate_rad_s.push_back(six_digits(w));
      for (const Side side : kSides) {
        const auto wheel_at = [&](double at_s) {
          return wheel_speeds_rad_s<double>(geometry, speed.at(at_s), yaw.at(at_s))[side];
        };
        const double turning = wheel_at(t),
                     current_A = 1 + 0.05 * turning + 0.3 * (wheel_at(t + 0.01) - wheel_at(t - 0.01)) / 0.02;
        log.wheel_speed_rad_s[side].push_back(six_digits(turning));
        if (!motors) continue;
        log.motor_current_A[side].push_back(six_digits(current_A));
        log.motor_voltage_V[side].push_back(six_digits(0.5 * current_A + 1.2 * turning));
      }
      log.position_x_m.push_back(six_digits(x_m));
      log.position_y_m.push_back(six_digits(y_m));
      log.heading_rad.push_back(six_digits(heading_rad));
      x_m += v * std::cos(heading_rad) * step_s, y_m += v * std::sin(heading_rad) * step_s;
      heading_rad += w * step_s;
    }
  }
  return day;
}

/// Runs without noise differ in how their motion bends, not in their units.
TEST(NoisyUnit, IsNoneOfRunsWithoutNoise) {
  int told = 0, days = 0;
  std::string which;
  for (const double rate_Hz : {2.0, 5.0, 10.0, 20.0, 50.0})
    for (const bool motors : {false, true})
      for (int seed = 0; seed < (rate_Hz > 20 ? 5 : 30); ++seed, ++days)
        for (const DataCheck& check : noisy_units(noise_free_day(seed, rate_Hz, motors))) {
          ++told;
          which += std::to_string(rate_Hz) + " Hz, " + std::to_string(seed) + ": " + check.channel + ", " +
                   check.evidence + '\n';
        }
  EXPECT_EQ(told, 0) << "of " << days << " days\n" << which;
}

/// Noise beside a motion that the other channels show.
TEST(NoisyUnit, OfNoisyRunsIsNamedAtEveryRate) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (const double rate_Hz : {10.0, 20.0, 50.0}) {
    Dataset day = noise_free_day(3, rate_Hz, true);
    for (joulepath::Run& run : day.runs) {
      for (double& rate : run.log.gyro_yaw_rate_rad_s) rate += 0.01 * noise(random);
      for (const Side side : kSides)
        for (double& speed : run.log.wheel_speed_rad_s[side]) speed += 0.02 * noise(random);
    }
    for (double& rate : day.runs[2].log.gyro_yaw_rate_rad_s) rate = 0.01 * noise(random);
    scale(day.runs[2].log.gyro_yaw_rate_rad_s, 180 / std::numbers::pi);
    const std::vector<DataCheck> found = noisy_units(day);
    ASSERT_EQ(found.size(), 1u) << rate_Hz;
    EXPECT_EQ(found[0].channel, "gyro_yaw_rate_rad_s") << rate_Hz;
    EXPECT_EQ(found[0].run, "run 2") << rate_Hz;
  }
}

/// Effects of the catalog at full size must not make the data suspect.
TEST(SoundData, WithEffectsOfFullSizeAreNotSuspect) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* effect : {"none --level 1",
                             "torque_constant_error --size 0.12",
                             "torque_constant_error --size -0.12",
                             "winding_resistance_error --size 0.35",
                             "winding_heating --size 0.4",
                             "time_misalignment --size 0.12",
                             "track_width_error --size 0.12",
                             "wheel_radius_mismatch --size 0.05",
                             "payload_mass_error --size 0.45",
                             "yaw_inertia_error --size 0.9",
                             "current_sensor_gain --size 0.15",
                             "floor_slope --size 0.02",
                             "rolling_resistance --size 0.02",
                             "regeneration_error --size 0.8 --robot warehouse",
                             "driver_foldback --robot small",
                             "encoder_drift --size 0.05",
                             "floor_patch --size 0.03",
                             "coulomb_friction --size 0.5",
                             "supply_sag --size 0.3",
                             "standby_power_error --size 0.8",
                             "eddy_brake",
                             "cold_grease"}) {
    const Dataset dataset = twelve_runs(std::string("--effect ") + effect + " --seed 5");
    for (const DataCheck& check : check_data(dataset, sort_runs(dataset)))
      ADD_FAILURE() << effect << ": " << check.run << " " << check.kind << " " << check.channel << ", "
                    << check.evidence;
  }
}

/// The battery's power does not tell the unit of its current from that of its voltage; the robot file does.
TEST(SpoiltBattery, TellsTheUnitOfItsVoltageFromThatOfItsCurrent) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const int seed : {1, 2, 3}) {
    const Dataset sound = twelve_runs("--effect none --seed " + std::to_string(seed));
    for (const char* column : {"battery_current_A", "battery_voltage_V"}) {
      Dataset dataset = sound;
      for (auto& run : dataset.runs) scale(find_log_column(column)->channel(run.log), 1e3);
      const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
      ASSERT_EQ(found.size(), 1u) << column << " of day " << seed;
      EXPECT_EQ(found[0].channel, column) << "day " << seed;
    }
  }
}

/// A current of one value is dead in every run, and swapped with the other side's in none.
TEST(SpoiltCurrent, OfOneValueIsDeadInAllRuns) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = testing::blind_day("--effect none --seed 12 --protocol 24 --label none");
  for (auto& run : dataset.runs) std::ranges::fill(run.log.motor_current_A.left, 0.0);
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, "dead");
  EXPECT_EQ(found[0].channel, "motor_current_left_A");
  EXPECT_EQ(found[0].run, "");
}

/// Wheel speeds and the battery: with predicted motor power the battery's law holds only as well as the
/// model does, and a few hundredths of a percent say nothing about a wheel's unit.
TEST(SoundData, OfOdometryAndBatteryAloneAreNotSuspect) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* day :
       {"none --seed 5", "none --seed 6 --level 1", "rolling_resistance --size 0.02 --seed 5",
        "turning_scrub --share 1 --seed 7", "viscous_friction --share 1 --seed 2 --robot small"}) {
    Dataset dataset = twelve_runs(std::string("--effect ") + day);
    for (auto& run : dataset.runs) {
      Trajectory& t = run.log;
      for (std::vector<double>* channel :
           {&t.motor_current_A.left, &t.motor_current_A.right, &t.motor_voltage_V.left,
            &t.motor_voltage_V.right, &t.gyro_yaw_rate_rad_s, &t.heading_rad, &t.position_x_m,
            &t.position_y_m})
        channel->clear();
    }
    for (const DataCheck& check : check_data(dataset, sort_runs(dataset)))
      ADD_FAILURE() << day << ": " << check.run << " " << check.kind << " " << check.channel << ", "
                    << check.evidence;
  }
}

/// What a repair of a dead channel leaves: voltages of both motors, the current of one.
TEST(DiagnosisOfOneCurrent, ReadsNoChannelThatIsAbsent) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const Side absent : kSides) {
    Dataset dataset = twelve_runs("--effect rolling_resistance --size 0.01 --seed 71");
    for (auto& run : dataset.runs) run.log.motor_current_A[absent].clear();
    const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
    ASSERT_FALSE(d.causes.empty()) << side_name(absent);
    EXPECT_EQ(d.causes[0].effect.name, "rolling_resistance");
  }
}

}  // namespace
}  // namespace joulepath
