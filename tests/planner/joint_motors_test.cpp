#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "model/limit_table.hpp"
#include "planner/joint/joint_search.hpp"
#include "planner/joint/motor_rows.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::joint {
namespace {

using Eigen::VectorXd;

constexpr double kPhi_rad = 0.3, kLength_m = 0.8, kPayload_kg = 3;

/// One piece of constant curvature in three parts of the speed, between rests.
Program arc_of(const DriveLaw& law) {
  Program program;
  program.pieces = {{0, 1, 1, 0, 0, true, 3}};
  program.knots = 2;
  program.laws = {law};
  return program;
}
VectorXd arc_parameters(double to_rad = kPhi_rad) {
  VectorXd p(3);
  p << kPhi_rad, to_rad, kLength_m;
  return p;
}
VectorXd arc_squares() {
  VectorXd squares(4);
  squares << 0, 0.25, 0.30, 0;
  return squares;
}

DriveLaw loaded_law(const Robot& robot) {
  return drive_law(make_nominal_plant(robot), limits_for_payload(robot, kPayload_kg), kPayload_kg, {}, 0);
}

/// The model's largest use of a limit at the ends of the arc's parts.
double model_use(const Robot& robot, const Limit& limit) {
  const Plant plant = make_nominal_plant(robot);
  const double A = std::cos(kPhi_rad), W = std::sin(kPhi_rad) / robot.geometry.half_track_m;
  const VectorXd squares = arc_squares();
  double most = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double gain = (squares[k + 1] - squares[k]) / (2 * kLength_m / 3);
    for (const double square : {squares[k], squares[k + 1]}) {
      const double u = std::sqrt(square);
      const BodyMotion<double> motion{A * u, A * gain, W * u, W * gain};
      const Site site = site_of(robot.geometry, {}, kPayload_kg, A, W);
      const LimitState state = limit_state(plant, motion, site, A * gain, 0);
      for (const Side side : kSides) most = std::max(most, std::abs(limit.value(state, side)));
    }
  }
  return most;
}

Robot with_limit(Robot robot, const Limit& limit, double most) {
  if (limit.field)
    (*robot.limits).*limit.field = most;
  else
    for (const Side side : kSides) robot.motor[side].*limit.rating = most;
  return robot;
}

/// A limit that is just what the model uses leaves nothing, and no limit leaves less.
TEST(MotorRows, ALimitOfWhatTheModelUsesIsUsedUp) {
  Robot robot = testing::nomad();
  robot.geometry.center_of_mass_offset_m = 0.05;
  robot.power.regeneration_efficiency = 0.6;
  robot.power.standby_W = 0;
  for (const Side side : kSides) robot.motor[side].friction_torque_Nm = 0.01;  // braking returns power
  for (const char* name : {"motor_current", "motor_voltage", "traction", "wheel_acceleration", "motor_power",
                           "battery_power", "charge_power"}) {
    const Limit& limit = *limit_named(name);
    const DriveLaw law = loaded_law(with_limit(robot, limit, model_use(robot, limit)));
    const Program program = arc_of(law);
    const std::vector<SpeedPart> parts = speed_parts(program);
    MotorRows rows(program, parts);
    rows.join(arc_squares(), arc_parameters(), 1e-3);
    ASSERT_GT(rows.size(), 0u) << name;
    double least = kNoLimit;
    for (const double unused : rows.present()) least = std::min(least, unused);
    EXPECT_NEAR(least, 0, 1e-9) << name;
  }
}

/// A robot whose other limits keep it far from those of its motors has no such rows.
TEST(MotorRows, ALimitOutOfReachIsNoRow) {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_voltage_V = 60;
  const DriveLaw law = loaded_law(robot);
  EXPECT_TRUE(law.wheel_limits.empty());
  EXPECT_TRUE(law.power_limits.empty());
}

/// Of a machine that several limits bind, on a piece that bends more and more: sum of -z x unused share.
TEST(MotorRows, DerivativesAreThoseOfDifferences) {
  Robot robot = testing::nomad();
  robot.limits->motor_power_W = robot.limits->battery_power_W = 12;
  robot.limits->wheel_acceleration_rad_s2 = 1;
  for (const Side side : kSides) robot.motor[side].max_current_A = 0.4;
  constexpr double kMu = 1e-3, h = 1e-4;
  const Program program = arc_of(loaded_law(robot));
  const std::vector<SpeedPart> parts = speed_parts(program);
  VectorXd x(5);  // the squares within, then the parameters
  x << arc_squares().segment(1, 2), arc_parameters(0.5);
  const auto squares_of = [](const VectorXd& at) { return VectorXd{{0, at[0], at[1], 0}}; };
  MotorRows rows(program, parts);
  rows.join(squares_of(x), x.tail(3), kMu);
  ASSERT_GT(rows.size(), 6u);
  const std::vector<double> here = rows.present();
  const auto z = [&](std::size_t row) { return kMu / std::max(here[row], 2e-2); };
  const auto sum = [&](const VectorXd& at) {
    const std::vector<double> unused = rows.values(squares_of(at), at.tail(3));
    double total = 0;
    for (std::size_t row = 0; row < unused.size(); ++row) total -= z(row) * unused[row];
    return total;
  };
  const auto moved = [&](Eigen::Index i, double di, Eigen::Index j, double dj) {
    VectorXd at = x;
    at[i] += di;
    at[j] += dj;
    return at;
  };
  std::vector<BorderedSystem::Part> unknowns;
  for (const SpeedPart& part : parts) unknowns.push_back({{part.b0, part.b1}, part.parameters});
  BorderedSystem system(unknowns, 2, 3);
  system.clear();
  rows.assemble(squares_of(x), x.tail(3), kMu, system);
  VectorXd gradient(5);
  gradient << system.lagrangian.squares, system.lagrangian.parameters;
  Eigen::MatrixXd slopes(rows.size(), 5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_NEAR(gradient[i], (sum(moved(i, h, i, 0)) - sum(moved(i, -h, i, 0))) / (2 * h), 1e-6) << i;
    const VectorXd up = moved(i, h, i, 0), down = moved(i, -h, i, 0);
    const auto above = rows.values(squares_of(up), up.tail(3)),
               below = rows.values(squares_of(down), down.tail(3));
    for (std::size_t row = 0; row < above.size(); ++row)
      slopes(static_cast<Eigen::Index>(row), i) = (above[row] - below[row]) / (2 * h);
  }
  for (Eigen::Index i = 2; i < 5; ++i)
    for (Eigen::Index j = 2; j <= i; ++j) {
      double expected = (sum(moved(i, h, j, h)) - sum(moved(i, h, j, -h)) - sum(moved(i, -h, j, h)) +
                         sum(moved(i, -h, j, -h))) /
                        (4 * h * h);
      for (std::size_t row = 0; row < here.size(); ++row) {
        const auto r = static_cast<Eigen::Index>(row);
        expected += z(row) / std::max(here[row], 2e-2) * slopes(r, i) * slopes(r, j);
      }
      EXPECT_NEAR(system.hessian(i - 2, j - 2), expected, 1e-4 * (1 + std::abs(expected))) << i << ", " << j;
    }
}

/// Cost of driving a path with a price of time, by the profile solver.
double priced_J(const Robot& robot, const Path& path, double price_W) {
  const Plant plant = make_nominal_plant(robot);
  const ProfileRequest request{.piece = path.pieces.front(),
                               .plant = plant,
                               .limits = limits_for_payload(robot, kPayload_kg),
                               .payload = {kPayload_kg, kPayload_kg},
                               .time = {TimeMode::time_price, kNoLimit, price_W},
                               .solver = SolverChoice::fast};
  const ProfileResult result = solve_profile(request);
  return result.profile ? result.summary.counted_J + price_W * result.profile->duration_s() : kNoLimit;
}

/// A path that knows what its motors can do is driven more cheaply than one that believes them strong.
TEST(Joint, APathForItsMotorsIsCheaperThanOneForStrongMotors) {
  const Robot strong = testing::nomad();
  constexpr double kPrice_W = 50;
  std::vector<std::pair<std::string, Robot>> weak{
      {"current", with_limit(strong, *limit_named("motor_current"), 0.5)},
      {"wheel acceleration", with_limit(strong, *limit_named("wheel_acceleration"), 3)},
      {"traction", with_limit(strong, *limit_named("traction"), 0.04)}};
  std::mt19937 random(11);
  std::uniform_real_distribution<> angle(-std::numbers::pi, std::numbers::pi), reach(2, 6);
  for (const auto& [name, robot] : weak) {
    std::vector<double> saved;
    for (int trial = 0; trial < 6; ++trial) {
      const double bearing = angle(random), reach_m = reach(random);
      const LegGoal goal{{reach_m * std::cos(bearing), reach_m * std::sin(bearing)}, angle(random)};
      const auto planned_J = [&](const Robot& believed) {
        std::vector<std::vector<Sketch>> starts;
        for (Sketch& word : words({}, goal, robot.geometry.half_track_m, {0.15, 0.5}))
          starts.push_back({std::move(word)});
        const Plant plant = make_nominal_plant(believed);
        const DriveLaw law =
            drive_law(plant, limits_for_payload(believed, kPayload_kg), kPayload_kg, {}, kPrice_W);
        const auto found = best_joint_paths({{}, {goal}, {law}, {}, nullptr}, starts);
        return found.empty() ? kNoLimit : priced_J(robot, found.front().legs.front(), kPrice_W);
      };
      saved.push_back(1 - planned_J(robot) / planned_J(strong));
      EXPECT_GT(saved.back(), -0.001) << name << trial;
    }
    EXPECT_GT(std::accumulate(saved.begin(), saved.end(), 0.0) / 6, 0.005) << name;
  }
}

}  // namespace
}  // namespace joulepath::joint
