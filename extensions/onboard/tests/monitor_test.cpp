#include "extensions/onboard/monitor/monitor.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <random>

#include "extensions/onboard/tests/simulated_day.hpp"
#include "model/normal_quantiles.hpp"
#include "model/operating_point.hpp"
#include "model/power.hpp"

namespace joulepath {
namespace {

using testing::Day;
using testing::day;
using testing::drive;
using testing::Hidden;
using testing::nomad;
using testing::row_of;

std::vector<CauseChange> changes(const Trajectory& log, double stated_kg, double hours = 100) {
  CauseWatch watch(nomad(), hours);
  std::vector<CauseChange> found;
  for (std::size_t k = 0; k < log.size(); ++k)
    if (const auto change = watch.add(row_of(log, k, stated_kg), stated_kg)) found.push_back(*change);
  return found;
}

TEST(MotionWindows, AccelerationIsExactOnUnevenRows) {
  MotionWindows windows(nomad().geometry);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(0.004, 0.03);
  const double r = 0.1, acceleration = 0.4;
  int seen = 0;
  for (double t = 0; t < 3; t += step(random)) {
    const double speed = (0.2 + acceleration * t) / r;
    const auto window = windows.add({.time_s = t, .wheel_speed_rad_s = {speed, speed}});
    if (!window) continue;
    ++seen;
    EXPECT_NEAR(window->motion.acceleration_m_s2, acceleration, 1e-9);
    EXPECT_NEAR(window->motion.yaw_acceleration_rad_s2, 0, 1e-9);
  }
  EXPECT_GT(seen, 5);
}

/// Current of the model, sampled along a motion whose acceleration changes within each window.
TEST(MotionWindows, MeanCurrentBelongsToTheMeanMotionWhateverTheJerk) {
  const Plant plant = make_nominal_plant(nomad());
  const Signatures signatures(nomad());
  MotionWindows windows(nomad().geometry);
  int seen = 0;
  for (double t = 0; t < 6; t += 0.01) {
    const BodyMotion<double> motion{.speed_m_s = 0.5 + 0.2 * std::sin(4 * t),
                                    .acceleration_m_s2 = 0.8 * std::cos(4 * t)};
    const auto wheels = operating_point(plant, motion, site_of(nomad().geometry, {}, 3, motion.speed_m_s, 0));
    const auto window = windows.add({.time_s = t,
                                     .wheel_speed_rad_s = {wheels.left.speed_rad_s, wheels.right.speed_rad_s},
                                     .motor_current_A = {wheels.left.current_A, wheels.right.current_A}});
    if (!window) continue;
    ++seen;
    const auto rows = signatures.equations(*window, 3);
    ASSERT_TRUE(rows);
    EXPECT_LT(rows->residual.cwiseAbs().maxCoeff(), 3e-3);
    EXPECT_NEAR(rows->per_kg(0), 0.1 * window->motion.acceleration_m_s2 / 2 / (24.9 * 0.069), 1e-9);
  }
  EXPECT_GT(seen, 10);
}

/// E[time to a false alarm] >= H, for a mean at the border of what is tolerated.
TEST(EDetector, FalseAlarmsAreNotMoreFrequentThanStated) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const double limit_h = 2.0, block_h = 0.01;
  double total_h = 0;
  int alarms = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    EDetector detector(0.3, {0.25, 0.5, 1.0}, limit_h);
    for (int k = 0; k < 2000; ++k) {
      total_h += block_h;
      const double sigma = k % 3 == 0 ? 0.5 : 1.5;
      if (!detector.add(0.3 + sigma * normal(random), sigma, block_h, k)) continue;
      ++alarms;
      break;
    }
  }
  EXPECT_GT(alarms, 50);
  EXPECT_GT(total_h / alarms, limit_h);
}

TEST(EDetector, SaysWhenTheMeanChanged) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  EDetector detector(0.3, {0.5, 1, 2}, 100);
  for (int k = 0; k < 400; ++k)
    if (detector.add((k < 200 ? 0.0 : 2.0) + 0.5 * normal(random), 0.5, 0.01, k)) {
      EXPECT_GE(k, 200);
      EXPECT_LT(k, 205);
      EXPECT_NEAR(detector.since_s(), 200, 1);
      return;
    }
  FAIL() << "no alarm";
}

TEST(CauseWatch, IsSilentWhereNothingIsHidden) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Day quiet = day(40, seed);
    EXPECT_TRUE(changes(drive(quiet, {}, seed).log, quiet.payload_kg).empty()) << seed;
  }
}

TEST(CauseWatch, WeighsAChangeOfPayloadAndSaysWhen) {
  const Day quiet = day(40);
  const double end_s = quiet.motion.trajectory.time_s.back();
  for (const double extra_kg : {-3.0, 1.0, 2.0, 5.0, 10.0}) {
    const auto found = changes(drive(quiet, {0.4, extra_kg, {}}).log, quiet.payload_kg);
    ASSERT_EQ(found.size(), 1u) << extra_kg;
    EXPECT_TRUE(found[0].payload) << extra_kg << ' ' << found[0].reason;
    EXPECT_NEAR(found[0].since_s, 0.4 * end_s, 40) << extra_kg;
    EXPECT_GT(found[0].time_s, 0.4 * end_s);
    const double sigma = std::hypot(found[0].extra_kg.sigma, 0.15);
    EXPECT_NEAR(found[0].extra_kg.value, extra_kg, 3 * sigma) << extra_kg;
  }
}

TEST(CauseWatch, OtherCausesAreNotPayload) {
  const Day quiet = day(40);
  const std::vector<EffectSetting> causes{
      {.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.15}}},
      {.name = "viscous_friction", .parameters = {{"coefficient_Nm_s_rad", 0.02}}},
      {.name = "floor_slope", .parameters = {{"grade", 0.01}, {"uphill_direction_rad", 0.3}}},
      {.name = "winding_heating", .parameters = {{"final_fraction", 0.3}, {"time_constant_s", 600}}},
      {.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}},
      {.name = "floor_patch",
       .parameters = {
           {"coefficient", 0.05}, {"x_min_m", 0}, {"x_max_m", 1.5}, {"y_min_m", -5}, {"y_max_m", 5}}}};
  for (const EffectSetting& cause : causes) {
    const auto found = changes(drive(quiet, {1.0, 0, {cause}}).log, quiet.payload_kg);
    for (const CauseChange& change : found)
      EXPECT_FALSE(change.payload) << cause.name << ": " << change.extra_kg.value << " kg";
    if (cause.name == "coulomb_friction") {
      ASSERT_FALSE(found.empty());
      EXPECT_NEAR(found[0].resistance.value, 0.15 / 0.36, 0.1);
    }
  }
}

/// What all blocks of a log say of the payload, without the tolerance: the robot file's errors are no noise.
Estimate pooled_kg(const CauseWatch& watch) {
  Estimate kg = watch.extra_kg().value();
  kg.sigma = std::sqrt(kg.sigma * kg.sigma - std::pow(watch.tolerance_kg() / kNormal95OneSided, 2));
  return kg;
}

/// The estimate at the end of a log, where `stated_kg(round)` is stated: a round ends with its second stop.
template <class Stated>
Estimate weighed_kg(const Trajectory& log, Stated&& stated_kg) {
  CauseWatch watch(nomad(), 1e6);
  int stops = 0;
  bool stands = true;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const bool stood = stands;
    stands = std::abs(log.wheel_speed_rad_s.left[k]) < 0.05;
    stops += stands && !stood;
    const double kg = stated_kg(stops / 2);
    (void)watch.add(row_of(log, k, kg), kg);
  }
  return pooled_kg(watch);
}

TEST(CauseWatch, APayloadThatIsStatedWrongIsKnownAsWellAsARightOne) {
  const Day quiet = day(20);
  const Trajectory log = drive(quiet, {}).log;
  const Estimate right = weighed_kg(log, [](int) { return 4.0; }),
                 wrong = weighed_kg(log, [](int) { return 1.0; });
  EXPECT_NEAR(right.value, 0.0, 0.3);
  EXPECT_NEAR(wrong.value, 3.0, 0.3);
  EXPECT_NEAR(wrong.sigma / right.sigma, 1.0, 0.4);
}

/// The mean over rounds of which every other one is off by 1 kg to either side is known less well.
TEST(CauseWatch, EstimatesThatScatterFromBlockToBlockAreKnownLessWell) {
  const Day quiet = day(20);
  const Trajectory log = drive(quiet, {}).log;
  const Estimate steady = weighed_kg(log, [](int) { return 4.0; }),
                 scattered = weighed_kg(log, [](int round) { return round % 2 == 0 ? 3.0 : 5.0; });
  EXPECT_NEAR(scattered.value, 0.0, 0.3);
  EXPECT_GT(scattered.sigma, 1.5 * steady.sigma);
}

/// One short block tells little of its own noise: what it weighs keeps within its sigma all the same.
TEST(CauseWatch, TheFirstShortBlockIsNotSurerThanItsNoise) {
  const Plant plant = make_nominal_plant(nomad());
  const auto causes = static_cast<double>(Signatures(nomad()).names().size() + 3);
  const double end_s = 0.3 * std::ceil((causes + 4) / 2) + 0.1;  // two rows a window, four more than causes
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  double squares = 0;
  constexpr int kDays = 40;
  for (int repeat = 0; repeat < kDays; ++repeat) {
    CauseWatch watch(nomad(), 100);
    for (double t = 0; t < end_s + 1; t += 0.02) {
      const BodyMotion<double> motion{.speed_m_s = 0.5 + 0.3 * std::sin(2 * t),
                                      .acceleration_m_s2 = 0.6 * std::cos(2 * t)};
      const auto wheels =
          operating_point(plant, motion, site_of(nomad().geometry, {}, 4, motion.speed_m_s, 0));
      MonitorRow row{.time_s = t, .payload_kg = 4};
      for (const Side side : kSides) {
        row.wheel_speed_rad_s[side] = t < end_s ? wheels[side].speed_rad_s : 0.0;
        row.motor_current_A[side] = wheels[side].current_A + 0.05 * normal(random);
      }
      (void)watch.add(row, 4);
    }
    ASSERT_EQ(watch.blocks(), 1u);
    const Estimate kg = pooled_kg(watch);
    squares += std::pow(kg.value / kg.sigma, 2) / kDays;
  }
  EXPECT_LT(squares, 2.0);
}

PlannedCourse course_of(const Day& planned) {
  SimulationResult ideal =
      simulate({.robot = nomad(), .reference = planned.motion.trajectory, .payload_kg = planned.payload_kg});
  ideal.executed.payload_kg.assign(ideal.executed.size(), planned.payload_kg);
  return planned_course(nomad().geometry, ideal.executed);
}

/// 10 m at 1 m/s, 20 s at rest, 10 m; 10 W. Odometry that reads too much passes no stop before it was made.
TEST(CourseProgress, AStopIsWaitedForWhateverTheOdometry) {
  PlannedCourse course;
  for (int k = 0; k <= 400; ++k) {
    const double time_s = 0.1 * k;
    course.time_s.push_back(time_s);
    course.travel_m.push_back(time_s <= 10 ? time_s : time_s <= 30 ? 10 : time_s - 20);
    course.energy_J.push_back(10 * time_s);
    course.payload_kg.push_back(0);
    course.leg.push_back(time_s <= 30 ? 0 : 1);
  }
  for (const double scale : {0.97, 1.0, 1.002, 1.03}) {
    CourseProgress progress(course);
    for (int k = 1; k <= 400; ++k) {
      const double time_s = 0.1 * k;
      progress.advance(0.1, time_s < 10.05 || time_s > 30.05 ? scale : 0);
      EXPECT_NEAR(progress.energy_J(), 10 * time_s, 12) << scale << " at " << time_s;
    }
  }
}

/// Drives, dwells of 4 s and turns on the spot, a leg each: a leg ends where the plan ends it, also where
/// ticks of the encoders flicker at rest and whatever the odometry.
TEST(CourseProgress, LegsEndWhereThePlanEndsThem) {
  const auto rim_m_s = [](double t) {
    return t < 10 ? 1.0 : t < 14 ? 0.0 : t < 20 ? 0.15 : t < 24 ? 0.0 : 0.5;
  };
  const auto leg_at = [](double t) { return t < 14 ? 0 : t < 24 ? 1 : 2; };
  PlannedCourse course;
  for (int k = 0; k <= 1700; ++k) {
    const double t = 0.02 * k;
    course.travel_m.push_back(k == 0 ? 0 : course.travel_m.back() + 0.02 * rim_m_s(t - 0.01));
    course.time_s.push_back(t);
    course.energy_J.push_back(10 * t);
    course.payload_kg.push_back(0);
    course.leg.push_back(static_cast<std::size_t>(leg_at(t)));
  }
  for (const double step_s : {0.005, 0.02, 0.1})
    for (const double scale : {0.99, 1.0, 1.01})
      for (const double tick_m : {0.0, 3e-4}) {
        CourseProgress progress(course);
        for (int k = 1; k * step_s < 33; ++k) {
          const double t = k * step_s, planned = rim_m_s(t - 0.5 * step_s);
          const bool ticks = planned == 0 && k % 5 == 0;
          progress.advance(step_s, ticks ? tick_m / step_s : scale * planned);
          const double next_s = t < 14 ? 14 : t < 24 ? 24 : 100, last_s = t < 14 ? 0 : t < 24 ? 14 : 24;
          if (t > last_s + 0.5 && t < next_s - 0.5) {
            ASSERT_EQ(progress.leg(), static_cast<std::size_t>(leg_at(t)))
                << t << " s, step " << step_s << ", scale " << scale << ", tick " << tick_m;
          }
        }
        EXPECT_NEAR(progress.leg_begin_J(1), 140, 1e-9);
        EXPECT_NEAR(progress.leg_begin_J(2), 240, 1e-9);
      }
}

TEST(Monitor, ExecutedIsPlannedWhereNothingIsHidden) {
  const Day quiet = day(10);
  Monitor monitor(nomad(), course_of(quiet), {});
  const Trajectory log = drive(quiet, {}).log;
  for (std::size_t k = 0; k < log.size(); ++k) {
    (void)monitor.add(row_of(log, k, kAbsent));
    const MonitorStatus now = monitor.status();
    if (now.time_s > 20) {
      EXPECT_NEAR(now.executed_J / now.planned_J, 1, 0.05) << now.time_s;
    }
  }
  EXPECT_NEAR(monitor.status().executed_J / monitor.status().planned_J, 1, 0.02);
  EXPECT_NEAR(monitor.status().rest_J, 0, 0.01 * monitor.status().planned_J);
}

/// 10 m at 1 m/s, planned with 10 W of the motors and 10 W of standby. Half as much deviates as half more
/// does.
TEST(Monitor, ALegThatTakesMoreOrLessThanPlannedDeviates) {
  PlannedCourse course;
  for (int k = 0; k <= 100; ++k) {
    course.time_s.push_back(0.1 * k);
    course.travel_m.push_back(0.1 * k);
    course.energy_J.push_back(2.0 * k);
    course.payload_kg.push_back(0);
    course.leg.push_back(0);
  }
  for (const double motors_W : {5.0, 10.0, 15.0}) {
    Monitor monitor(nomad(), course, {});
    for (int k = 0; k < 100; ++k)
      (void)monitor.add({.time_s = 0.1 * k,
                         .wheel_speed_rad_s = {10, 10},
                         .motor_voltage_V = {10, 10},
                         .motor_current_A = {motors_W / 20, motors_W / 20},
                         .payload_kg = 0});
    const LegExecuted leg = monitor.leg_executed();
    EXPECT_NEAR(leg.executed_J, 9.9 * (motors_W + 10), 1e-6);
    EXPECT_EQ(leg.deviates, motors_W != 10.0) << motors_W;
  }
}

/// Rows doubled, out of order, without numbers, left out: the same change is found.
TEST(Monitor, NoRowStopsIt) {
  const Day quiet = day(30);
  Trajectory log = drive(quiet, {0.4, 5.0, {}}).log;
  Monitor monitor(nomad(), course_of(quiet), {});
  std::mt19937 random(5);
  int payload = 0;
  const auto give = [&](const MonitorRow& row) {
    for (const MonitorEvent& event : monitor.add(row))
      payload += std::holds_alternative<PayloadChanged>(event);
  };
  for (std::size_t k = 0; k < log.size(); ++k) {
    MonitorRow row = row_of(log, k, quiet.payload_kg);
    const unsigned what = random() % 100;
    if (what == 0) continue;
    if (what == 1) row.wheel_speed_rad_s.left = kAbsent;
    if (what == 2) row.motor_current_A.right = kAbsent;
    if (what == 3) row.time_s = std::numeric_limits<double>::infinity();
    give(row);
    if (what == 4) give(row);
    if (what == 5 && k > 10) give(row_of(log, k - 7, quiet.payload_kg));
    if (what == 6) give({});
    MonitorRow absurd = row;
    absurd.battery_current_A = absurd.motor_current_A.left = 1e300;
    if (what == 7) give(absurd);
  }
  EXPECT_EQ(payload, 1);
  const RowCounts& rows = monitor.status().rows;
  EXPECT_GT(rows.late, 0u);
  EXPECT_GT(rows.broken, 0u);
  EXPECT_GT(rows.missing, 0u);
}

/// One sample that no robot has, in any channel: a broken row, and the same answer as without it.
TEST(Monitor, OneBadSampleChangesNothing) {
  const Day quiet = day(4);
  const Trajectory log = drive(quiet, {}).log;
  using Spoil = void (*)(MonitorRow&);
  const Spoil spoils[] = {[](MonitorRow& r) { r.wheel_speed_rad_s.left = 1e6; },
                          [](MonitorRow& r) { r.wheel_speed_rad_s.right = -3000; },
                          [](MonitorRow& r) { r.battery_voltage_V = 24, r.battery_current_A = -1e5; },
                          [](MonitorRow& r) { r.motor_current_A.left = 500; },
                          [](MonitorRow& r) { r.motor_voltage_V.right = -24000; },
                          [](MonitorRow& r) {
                            r.motor_power_W = {9e4, 9e4};
                          },
                          [](MonitorRow& r) { r.payload_kg = 5e4; }};
  Monitor clean(nomad(), course_of(quiet), {});
  for (std::size_t k = 0; k < log.size(); ++k) (void)clean.add(row_of(log, k, quiet.payload_kg));
  for (const Spoil& spoil : spoils) {
    Monitor spoilt(nomad(), course_of(quiet), {});
    for (std::size_t k = 0; k < log.size(); ++k) {
      MonitorRow row = row_of(log, k, quiet.payload_kg);
      if (k == 500) spoil(row);
      (void)spoilt.add(row);
    }
    EXPECT_EQ(spoilt.status().rows.broken, 1u);
    EXPECT_FALSE(spoilt.implausible());
    EXPECT_NEAR(spoilt.status().executed_J, clean.status().executed_J, 2e-3 * clean.status().executed_J);
    EXPECT_NEAR(*spoilt.status().payload_kg, *clean.status().payload_kg, 0.2);
  }
}

void scale(Sided<double>& values, double factor) { values.left *= factor, values.right *= factor; }

/// A unit that is wrong in every row is no glitch: mA, mV, ms, degrees of the wheels.
TEST(Monitor, AnotherUnitIsTold) {
  const Day quiet = day(2);
  const Trajectory log = drive(quiet, {}).log;
  struct Case {
    const char* channel;
    void (*spoil)(MonitorRow&);
  };
  for (const Case& c : {Case{"motor_current", [](MonitorRow& r) { scale(r.motor_current_A, 1e3); }},
                        Case{"motor_voltage", [](MonitorRow& r) { scale(r.motor_voltage_V, 1e3); }},
                        Case{"wheel_speed", [](MonitorRow& r) { scale(r.wheel_speed_rad_s, 57.3); }},
                        Case{"time_s", [](MonitorRow& r) { r.time_s *= 1e3; }},
                        Case{"time_s", [](MonitorRow& r) { r.time_s = 1.76e12 + 1e3 * r.time_s; }}}) {
    Monitor monitor(nomad(), course_of(quiet), {});
    for (std::size_t k = 0; k < log.size() && !monitor.implausible(); ++k) {
      MonitorRow row = row_of(log, k, quiet.payload_kg);
      c.spoil(row);
      (void)monitor.add(row);
    }
    ASSERT_TRUE(monitor.implausible()) << c.channel;
    EXPECT_TRUE(monitor.implausible()->channel.starts_with(c.channel)) << monitor.implausible()->channel;
  }
}

/// A payload or an effect that nobody stated is no fault of the log.
TEST(Monitor, BelievesTheLogWhateverTheRobotHides) {
  const Day quiet = day(40);
  for (const Hidden& hidden :
       {Hidden{}, Hidden{0.4, 10.0, {}}, Hidden{0.0, -3.0, {}},
        Hidden{1.0, 0, {{.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.15}}}}},
        Hidden{1.0, 0, {{.name = "viscous_friction", .parameters = {{"coefficient_Nm_s_rad", 0.02}}}}},
        Hidden{1.0, 0, {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}}},
        Hidden{1.0, 0, {{.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 4000}}}}},
        Hidden{1.0,
               0,
               {{.name = "floor_slope", .parameters = {{"grade", 0.01}, {"uphill_direction_rad", 0.3}}}}}}) {
    const Trajectory log = drive(quiet, hidden).log;
    Monitor monitor(nomad(), course_of(quiet), {});
    for (std::size_t k = 0; k < log.size(); ++k) (void)monitor.add(row_of(log, k, quiet.payload_kg));
    EXPECT_FALSE(monitor.implausible()) << monitor.implausible()->channel << monitor.implausible()->found;
  }
}

/// Single rows on another clock, and a clock that is set anew: the same energy at the same place.
TEST(Monitor, AnotherClockMovesNothing) {
  const Day quiet = day(6);
  const Trajectory log = drive(quiet, {}).log;
  Monitor steady(nomad(), course_of(quiet), {}), disturbed(nomad(), course_of(quiet), {});
  for (std::size_t k = 0; k < log.size(); ++k) {
    MonitorRow row = row_of(log, k, quiet.payload_kg);
    (void)steady.add(row);
    for (const double wild_s : {1e9, -1e9, row.time_s + 600, row.time_s - 600}) {
      MonitorRow wild = row;
      wild.time_s = wild_s;
      if (k % 400 == 100) (void)disturbed.add(wild);
    }
    if (2 * k > log.size()) row.time_s += 1.7e9;
    (void)disturbed.add(row);
    ASSERT_LT(disturbed.status().time_s, log.time_s.back() + 1) << k;
  }
  EXPECT_NEAR(disturbed.status().executed_J, steady.status().executed_J, 2e-3 * steady.status().executed_J);
  EXPECT_NEAR(disturbed.status().planned_J, steady.status().planned_J, 2e-3 * steady.status().planned_J);
  EXPECT_GT(disturbed.status().rows.late, 4u);
}

/// The robot waits for ten minutes without a log.
TEST(Monitor, ALongGapIsTimeThatPassed) {
  const Day quiet = day(2);
  const Trajectory log = drive(quiet, {}).log;
  Monitor monitor(nomad(), course_of(quiet), {});
  (void)monitor.add(row_of(log, 0, quiet.payload_kg));
  for (const double time_s : {600.0, 600.1}) {
    MonitorRow row = row_of(log, 0, quiet.payload_kg);
    row.time_s = time_s;
    (void)monitor.add(row);
  }
  EXPECT_EQ(monitor.status().time_s, 600.1);
  EXPECT_GT(monitor.status().bridged_s, 590);
}

TEST(Monitor, MemoryIsConstant) {
  const Day quiet = day(4);
  const Trajectory log = drive(quiet, {}).log;
  Monitor monitor(nomad(), course_of(quiet), {});
  const double length_s = log.time_s.back() + 1;
  std::size_t after_first = 0, after_last = 0;
  for (int round = 0; round < 60; ++round) {
    for (std::size_t k = 0; k < log.size(); ++k) {
      MonitorRow row = row_of(log, k, quiet.payload_kg);
      row.time_s += round * length_s;
      (void)monitor.add(row);
    }
    (round < 5 ? after_first : after_last) = mallinfo2().uordblks;
  }
  EXPECT_LE(after_last, after_first + 32768);  // freed blocks that the allocator keeps count, too
}

TEST(Monitor, AnEmptyBatteryIsToldBeforeItIsEmpty) {
  const Day quiet = day(10);
  PlannedCourse course = course_of(quiet);
  Robot robot = nomad();
  robot.battery.capacity_Wh = course.energy_J.back() / 3600;
  const Trajectory log = drive(quiet, {}).log;
  for (const double start : {1.3, 0.9}) {
    course.battery_fraction = start;
    Monitor monitor(robot, course, {});
    for (std::size_t k = 0; k < log.size() / 3; ++k) (void)monitor.add(row_of(log, k, quiet.payload_kg));
    ASSERT_TRUE(monitor.status().battery_suffices);
    EXPECT_EQ(*monitor.status().battery_suffices, start > 1);
  }
}

}  // namespace
}  // namespace joulepath
