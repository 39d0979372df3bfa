// Wheel radius and track by the pose: exact factors of a wrong file, silence on everything else.
#include "diagnosis/checks/pose_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "diagnosis/values/diagnosis.hpp"
#include "model/log_columns.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

PoseGeometry told_by(const Dataset& day) {
  std::vector<RunSignals> signals;
  for (std::size_t r = 0; r < day.runs.size(); ++r)
    signals.push_back(make_run_signals(day.runs[r], r, day.robot));
  return geometry_by_pose(day, signals);
}

Dataset day_on(const std::string& robot, const std::string& effect = "none", int runs = 6) {
  return testing::blind_day("--effect " + effect + " --robot " + robot + " --protocol " +
                            std::to_string(runs) + " --seed 71 --label none");
}

/// A day whose file states other wheels than drove it.
Dataset with_file(Dataset day, double radius, double half_track) {
  for (const Side side : kSides) day.robot.geometry.wheel_radius_m[side] *= radius;
  day.robot.geometry.half_track_m *= half_track;
  return day;
}

/// Another frame of the positions, and for some runs of the heading, too; readings `late` samples old.
Dataset in_another_frame(Dataset day, std::size_t late) {
  for (std::size_t r = 0; r < day.runs.size(); ++r) {
    Trajectory& log = day.runs[r].log;
    const double angle = 0.4 + static_cast<double>(r);
    for (std::size_t i = 0; i < log.size(); ++i) {
      const double x = log.position_x_m[i], y = log.position_y_m[i];
      log.position_x_m[i] = std::cos(angle) * x - std::sin(angle) * y + 7;
      log.position_y_m[i] = std::sin(angle) * x + std::cos(angle) * y - 3;
      if (r % 2 == 0) log.heading_rad[i] += angle;
    }
    for (auto* pose : {&log.position_x_m, &log.position_y_m, &log.heading_rad}) {
      pose->insert(pose->begin(), late, pose->front());
      pose->resize(log.size());
    }
  }
  return day;
}

/// A pose that has a new value at every `rows`-th row only, and noise of its own.
Dataset with_held_pose(Dataset day, std::size_t rows, double noise_m) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, noise_m);
  for (joulepath::Run& run : day.runs)
    for (auto* pose : {&run.log.position_x_m, &run.log.position_y_m, &run.log.heading_rad})
      for (std::size_t i = 0; i < pose->size(); ++i)
        (*pose)[i] = i % rows == 0 ? (*pose)[i] + noise(random) : (*pose)[i - 1];
  return day;
}

/// Every so many rows of a log.
Dataset thinned_to(Dataset day, std::size_t stride) {
  for (joulepath::Run& run : day.runs)
    for (const LogColumn& column : log_columns()) {
      std::vector<double>& channel = column.channel(run.log);
      for (std::size_t i = 0; i * stride < channel.size(); ++i) channel[i] = channel[i * stride];
      channel.resize((channel.size() + stride - 1) / stride);
    }
  return day;
}

double log_rate_Hz(const Dataset& day) {
  const std::vector<double>& time_s = day.runs[0].log.time_s;
  return static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
}

class PoseGeometryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  }
};

TEST_F(PoseGeometryTest, TellsTheRadiusOfTheRobotThatDrove) {
  for (const char* robot : {"nomad", "warehouse", "small", "tug"})
    for (const double factor : {0.5, 0.93, 1.07, 2.0})
      for (const bool moved : {false, true}) {
        const Dataset day = with_file(day_on(robot), factor, 1);
        const PoseGeometry told = told_by(moved ? in_another_frame(day, 10) : day);
        EXPECT_NEAR(told.radius * factor, 1, 0.015) << robot << ' ' << factor << ' ' << moved;
        EXPECT_EQ(told.half_track, 1) << robot << ' ' << factor << ' ' << moved;
      }
}

TEST_F(PoseGeometryTest, TellsTheTrackOfTheRobotThatDroveWhateverTheRadius) {
  for (const char* robot : {"nomad", "tug"})
    for (const double track : {0.5, 0.9, 1.1, 2.0})
      for (const double radius : {0.8, 1.0}) {
        const PoseGeometry told = told_by(with_file(day_on(robot, "none", 12), radius, track));
        EXPECT_NEAR(told.half_track * track, 1, 0.03) << robot << ' ' << track << ' ' << radius;
        EXPECT_NEAR(told.radius * radius, 1, 0.015) << robot << ' ' << track << ' ' << radius;
      }
}

/// Slip grows with force, and is none of the radius; nor is what a pose's clock, frame or absence adds.
TEST_F(PoseGeometryTest, IsSilentOnTheRightFile) {
  const auto is_silent = [](const Dataset& day) {
    const PoseGeometry told = told_by(day);
    return told.radius == 1 && told.half_track == 1;
  };
  for (const char* robot : {"nomad", "small", "tug"})
    for (const char* effect : {"none", "wheel_slip --size 400", "wheel_slip,floor_slope --size 1000,0.03",
                               "wheel_radius_mismatch --size 0.03", "wheel_eccentricity", "encoder_drift"}) {
      Dataset day = day_on(robot, effect);
      EXPECT_TRUE(is_silent(day)) << robot << ' ' << effect;
      EXPECT_TRUE(is_silent(in_another_frame(day, 20))) << robot << ' ' << effect << ", late";
      for (joulepath::Run& run : day.runs) run.log.position_x_m.clear();
      EXPECT_TRUE(is_silent(day)) << robot << ' ' << effect << ", no position";
    }
}

/// A localization slower than the log, here of 20 Hz: its readings are where the log repeats none.
TEST_F(PoseGeometryTest, TellsTheFactorOfAPoseThatTheLogHolds) {
  for (const char* robot : {"nomad", "tug"}) {
    Dataset day = day_on(robot, "none", 12);
    day = thinned_to(day, static_cast<std::size_t>(std::lround(log_rate_Hz(day) / 20)));
    for (const std::size_t rows : {1u, 5u, 10u})
      for (const double noise_m : {0.0, 0.01}) {
        const Dataset held = with_held_pose(day, rows, noise_m);
        const auto where = [&](double factor) {
          return std::string(robot) + ", " + std::to_string(rows) + " rows, " + std::to_string(noise_m) +
                 " m, " + std::to_string(factor);
        };
        for (const double factor : {0.5, 0.9, 1.1, 2.0}) {
          const PoseGeometry radius = told_by(with_file(held, factor, 1));
          EXPECT_NEAR(radius.radius * factor, 1, 0.015) << where(factor);
          EXPECT_EQ(radius.half_track, 1) << where(factor);
        }
        for (const double factor : {0.5, 0.8, 1.25, 2.0}) {
          const PoseGeometry track = told_by(with_file(held, 1, factor));
          EXPECT_NEAR(track.half_track * factor, 1, 0.03) << where(factor);
          EXPECT_NEAR(track.half_track / told_by(with_file(day, 1, factor)).half_track, 1, 0.015)
              << where(factor);
          EXPECT_EQ(track.radius, 1) << where(factor);
        }
        for (const double factor : {0.99, 1.0, 1.01}) {
          EXPECT_EQ(told_by(with_file(held, factor, 1)).radius, 1) << where(factor);
          EXPECT_EQ(told_by(with_file(held, 1, factor)).half_track, 1) << where(factor);
        }
      }
  }
}

TEST_F(PoseGeometryTest, IsSilentWhereTheWheelsAreThoseOfTheFile) {
  Dataset day = with_file(day_on("nomad"), 2, 1);
  for (joulepath::Run& run : day.runs) run.wheels_from_body_speeds = true;
  EXPECT_EQ(told_by(day).radius, 1);
}

TEST_F(PoseGeometryTest, AnotherRadiusIsToldBeforeAnyInertia) {
  const Dataset day = day_on("tug");
  const Diagnosis d = diagnose(with_file(day, 0.5, 1), {.bootstrap = 20});
  ASSERT_EQ(d.foreign_constants.size(), 1u);
  EXPECT_EQ(d.foreign_constants[0].name, "wheel radius");
  const double radius_m = day.robot.geometry.wheel_radius_m.left;
  EXPECT_NEAR(d.foreign_constants[0].in_runs, radius_m, 0.02 * radius_m);
  ASSERT_FALSE(d.notes.empty());
  EXPECT_EQ(d.notes[0].rfind("the pose moves ", 0), 0u) << d.notes[0];
  EXPECT_NE(d.notes[0].find(": wheel_radius_m 0.0625 -> 0.12"), std::string::npos) << d.notes[0];
}

}  // namespace
}  // namespace joulepath
