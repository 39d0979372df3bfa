// Values and exact derivatives of the joint program: pieces of paths, places, clearances, limits and power.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "planner/joint/clearance_rows.hpp"
#include "planner/joint/joint_problem.hpp"
#include "planner/joint/joint_segment.hpp"
#include "planner/joint/path_geometry.hpp"
#include "tests/planner/joint_laws.hpp"
#include "tests/planner/path/curve_laws.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath::joint {
namespace {

TEST(DirectionSegment, ChannelsAreIntegralsOfEachOther) {
  for (const auto& [from, to, length_m] :
       {std::array{1.4, -0.3, 0.6}, std::array{-0.2, 1.45, 1.5}, std::array{0.9, 0.9, 2.0}}) {
    const Curve curve({DirectionSegment({1, -2, 0.7}, {from, to, length_m, 0.165})});
    const CurveBreach breach = curve_breach(curve);
    EXPECT_LT(breach.position_m, 1e-10);
    EXPECT_LT(breach.heading_rad, 1e-7);
    EXPECT_LT(breach.curvature_per_m, 1e-3);
    const double most = std::get<DirectionSegment>(curve.segments().front()).curvature_bound_per_m();
    EXPECT_NEAR(most, std::tan(std::max(std::abs(from), std::abs(to))) / 0.165, 1e-9);
  }
}

/// Three pieces with a stop after the second one, and two targets.
Program bent_program(const DriveLaw& law) {
  Program program;
  program.pieces = {{0, 1, 1, 0, 0, false, 5}, {1, 2, 1, 0, 0, true, 5}, {3, 4, 1, 1, 1, true, 5}};
  program.knots = 5;
  program.targets = {{1, {0.4, 0.1}, {}}, {2, {0.8, 0.5}, 1.2}};
  program.laws = {law, law};
  return program;
}
Eigen::VectorXd bent_parameters() {
  Eigen::VectorXd p(8);
  p << 0.7, -0.3, 0.4, 1.1, 0.2, 0.5, 0.3, 0.6;
  return p;
}

TEST(JointGeometry, FirstDerivativesAreThoseOfDifferences) {
  const Program program = bent_program(law_of(even_nomad()));
  const Eigen::VectorXd p = bent_parameters();
  PathGeometry geometry(program);
  geometry.differentiate(p);
  const Eigen::MatrixXd gradient = geometry.error_gradient();
  constexpr double h = 1e-6;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    Eigen::VectorXd up = p, down = p;
    up[i] += h;
    down[i] -= h;
    PathGeometry a(program), b(program);
    a.place(up);
    b.place(down);
    EXPECT_LT((gradient.col(i) - (a.errors() - b.errors()) / (2 * h)).norm(), 1e-8) << i;
  }
}

// The contracted second derivatives of both targets and of a place with a heading in between.
TEST(JointGeometry, SecondDerivativesAreThoseOfDifferences) {
  const Program program = bent_program(law_of(even_nomad()));
  const Eigen::VectorXd p = bent_parameters();
  const Eigen::VectorXd lambda = (Eigen::VectorXd(5) << 1.3, -0.7, 0.4, 2.0, -1.1).finished();
  const Eigen::Vector3d inside{0.8, -0.5, 0.9};
  constexpr std::size_t kPiece = 1;
  constexpr double kShare = 0.6, h = 1e-6;
  const auto slope = [&](const Eigen::VectorXd& at) {
    PathGeometry geometry(program);
    geometry.differentiate(at);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p.size()), lagrangian = gradient;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(p.size(), p.size());
    geometry.sums(kPiece).lagrangian =
        geometry.slopes(kPiece, geometry.local(kPiece, kShare)).transpose() * inside;
    geometry.add_sums(lambda, gradient, lagrangian, hessian);
    return lagrangian;
  };
  PathGeometry geometry(program);
  geometry.differentiate(p);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p.size()), lagrangian = gradient;
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(p.size(), p.size());
  const LocalPose local = geometry.local(kPiece, kShare);
  geometry.sums(kPiece).lagrangian = geometry.slopes(kPiece, local).transpose() * inside;
  geometry.sums(kPiece).hessian = geometry.curvature(kPiece, local, inside);
  geometry.add_sums(lambda, gradient, lagrangian, hessian);
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    Eigen::VectorXd up = p, down = p;
    up[i] += h;
    down[i] -= h;
    EXPECT_LT((hessian.col(i) - (slope(up) - slope(down)) / (2 * h)).norm(), 1e-7) << i;
  }
}

// Of the targets and of a place in between, as functions of the parameters.
TEST(JointGeometry, SumsOfFirstDerivativesAreThoseOfDifferences) {
  const Program program = bent_program(law_of(even_nomad()));
  const Eigen::VectorXd p = bent_parameters();
  const Eigen::VectorXd lambda = (Eigen::VectorXd(5) << 1.3, -0.7, 0.4, 2.0, -1.1).finished();
  const Eigen::Vector3d inside{0.8, -0.5, 0.9};
  constexpr std::size_t kPiece = 2;
  constexpr double kShare = 0.6, h = 1e-6;
  const auto at_place = [&](const PathGeometry& geometry) {
    const Pose pose = geometry.pose(kPiece, kShare);
    return inside.dot(Eigen::Vector3d(pose.x_m, pose.y_m, pose.heading_rad));
  };
  PathGeometry geometry(program);
  geometry.differentiate(p);
  PieceSums& sums = geometry.sums(kPiece);
  sums.gradient = geometry.slopes(kPiece, geometry.local(kPiece, kShare)).transpose() * inside;
  sums.lagrangian = 2 * sums.gradient;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p.size()), lagrangian = gradient;
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(p.size(), p.size());
  geometry.add_sums(lambda, gradient, lagrangian, hessian);
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    PathGeometry up(program), down(program);
    const Eigen::VectorXd above = p + h * Eigen::VectorXd::Unit(p.size(), i), below = 2 * p - above;
    up.place(above);
    down.place(below);
    const double of_place = (at_place(up) - at_place(down)) / (2 * h),
                 of_targets = lambda.dot(up.errors() - down.errors()) / (2 * h);
    EXPECT_NEAR(gradient[i], of_place, 1e-7) << i;
    EXPECT_NEAR(lagrangian[i], 2 * of_place + of_targets, 1e-7) << i;
  }
}

// A small change of all parameters moves the starts and ends of the pieces as both say.
TEST(JointGeometry, ChangesAndDisplacementAreThoseOfDifferences) {
  const Program program = bent_program(law_of(even_nomad()));
  const Eigen::VectorXd p = bent_parameters();
  const Eigen::VectorXd step = (Eigen::VectorXd(8) << 0.3, -0.8, 0.5, 1.0, -0.4, 0.7, -0.6, 0.2).finished();
  constexpr double h = 1e-6;
  PathGeometry geometry(program), up(program), down(program);
  geometry.differentiate(p);
  const Eigen::VectorXd above = p + h * step, below = p - h * step;
  up.place(above);
  down.place(below);
  const std::vector<PieceGradient> changes = geometry.changes(step);
  double squares = 0;
  for (std::size_t j = 0; j < program.pieces.size(); ++j) {
    const Pose a = up.pose(j, 0), b = down.pose(j, 0), c = up.pose(j, 1), d = down.pose(j, 1);
    const Eigen::Vector3d moved{a.x_m - b.x_m, a.y_m - b.y_m, a.heading_rad - b.heading_rad};
    EXPECT_LT((changes[j].head<3>() - moved / (2 * h)).norm(), 1e-7) << j;
    squares += std::pow(std::hypot(c.x_m - d.x_m, c.y_m - d.y_m) / (2 * h), 2);
  }
  const double mean = squares / static_cast<double>(program.pieces.size());
  EXPECT_NEAR(step.dot(geometry.displacement_metric() * step), mean, 1e-6 * mean);
}

/// A block of 0.2 x 0.15 m; its upper left corner is at (2.9, 1.65).
OccupancyGrid block() {
  OccupancyGrid grid = free_grid(120, 80, 0.05);
  for (int row = 30; row < 33; ++row)
    for (int column = 58; column < 62; ++column)
      grid.occupancy_percent[static_cast<std::size_t>(row * 120 + column)] = 100;
  return grid;
}

// A path of two pieces past the corner: the place with the least clearance moves along it. It lies inside the
// second piece, or near the knot, where rows of both pieces see it.
void expect_derivatives_of_differences(const Eigen::VectorXd& p) {
  constexpr double kMu = 1e-2, h = 1e-4;
  const ObstacleField field(block());
  const FootprintChecker checker(field, testing::nomad().footprint, 0.05);
  Program program;
  program.pieces = {{0, 1, 1, 0, 0, false, 5}, {1, 2, 1, 0, 0, true, 5}};
  program.knots = 3;
  program.laws = {law_of(even_nomad())};
  program.frame = {1.85, 1.487, 0.5};
  program.checker = &checker;
  PathGeometry start(program);
  start.place(p);
  ClearanceRows rows(program);
  rows.lay_out(p);
  rows.begin(rows.nearest(start), kMu);
  struct Sums {
    Eigen::VectorXd gradient, lagrangian;
    Eigen::MatrixXd hessian;
  };
  const auto sums_at = [&](const Eigen::VectorXd& at) {
    Sums sums{Eigen::VectorXd::Zero(5), Eigen::VectorXd::Zero(5), Eigen::MatrixXd::Zero(5, 5)};
    PathGeometry geometry(program);
    geometry.differentiate(at);
    ClearanceRows there = rows;
    there.take(rows.nearest(geometry), 0, 0, kMu);
    there.assemble(geometry, kMu);
    geometry.add_sums({}, sums.gradient, sums.lagrangian, sums.hessian);
    return sums;
  };
  const Eigen::MatrixXd hessian = sums_at(p).hessian;
  Eigen::MatrixXd differences(5, 5), stiffness = Eigen::MatrixXd::Zero(5, 5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(5, i);
    differences.col(i) = (sums_at(p + step).lagrangian - sums_at(p - step).lagrangian) / (2 * h);
  }
  // The rows of one corner have one gradient g, slack s and multiplier z: their stiffness is z / s g g'.
  std::vector<double> slacks;
  for (const ClearanceRows::Nearest& at : rows.nearest(start)) slacks.push_back(at.slack_m);
  const double least = *std::min_element(slacks.begin(), slacks.end());
  const auto at_corner = static_cast<double>(
      std::count_if(slacks.begin(), slacks.end(), [&](double slack) { return slack < least + 1e-6; }));
  const double s = std::max(least, 0.03), z = kMu / s;
  const Eigen::VectorXd g = -sums_at(p).lagrangian / (at_corner * z);
  stiffness = at_corner * z / s * g * g.transpose();
  EXPECT_LT(least, 0.1);
  EXPECT_LT((hessian - stiffness - differences).norm(), 0.03 * differences.norm()) << p.transpose();
}

TEST(ClearanceRows, SecondDerivativesAreThoseOfDifferences) {
  expect_derivatives_of_differences((Eigen::VectorXd(5) << 0.03, -0.02, 0.04, 0.8, 1.1).finished());
  for (const double first_length_m : {0.95, 1.05})
    expect_derivatives_of_differences(
        (Eigen::VectorXd(5) << 0.01, -0.02, 0.02, first_length_m, 1.1).finished());
}

/// At rate 1 along a straight piece (phi = 0) or a turn: each limit's row is 0 where the motion is at the
/// limit.
TEST(JointSegment, ARowIsZeroAtItsLimitForwardAndInReverse) {
  const Limits most = limits_for_payload(testing::nomad(), 0);
  const double unequal = 0.5 * most.deceleration_m_s2;
  Limits limits = most;
  limits.deceleration_m_s2 = unequal;
  const auto least = [&](int sign, std::array<double, kSegmentQuantities> quantities) {
    double worst = kNoLimit;
    for (const RowLaw& row : row_laws(limits, sign))
      worst = std::min(worst, 1 + row.slope * quantities[row.quantity]);
    return worst;
  };
  const double v = most.speed_m_s, a = most.acceleration_m_s2, d = unequal,
               side = most.lateral_acceleration_m_s2, w = most.yaw_rate_rad_s,
               turn = most.yaw_acceleration_rad_s2;
  EXPECT_NEAR(least(1, {v * v, 0, 0, 0, 0, 0, 0}), 0, 1e-12);
  for (const double s : {1.0, -1.0}) {
    EXPECT_NEAR(least(1, {0, s * side, 0, 0, 0, 0, 0}), 0, 1e-12);
    EXPECT_NEAR(least(1, {0, 0, 0, 0, s * turn, 0, 0}), 0, 1e-12);
    EXPECT_NEAR(least(1, {0, 0, 0, 0, 0, 0, s * turn}), 0, 1e-12);
  }
  EXPECT_NEAR(least(1, {0, 0, w * w, 0, 0, 0, 0}), 0, 1e-12);
  for (const std::size_t end : {3u, 5u}) {
    std::array<double, kSegmentQuantities> gains{}, loses{};
    gains[end] = a, loses[end] = -d;
    EXPECT_NEAR(least(1, gains), 0, 1e-12);
    EXPECT_NEAR(least(1, loses), 0, 1e-12);
    gains[end] = -a, loses[end] = d;  // in reverse
    EXPECT_NEAR(least(-1, gains), 0, 1e-12);
    EXPECT_NEAR(least(-1, loses), 0, 1e-12);
    EXPECT_LT(least(1, gains), -0.5);
  }
}

TEST(JointSegment, DerivativesAreThoseOfDifferences) {
  using Jet = nlp::JetOf<kSegmentVariables>;
  const DriveLaw law = law_of(testing::nomad());
  const std::array<double, kSegmentVariables> x{0.2, 0.25, 0.7, -0.4, 0.8};
  const auto values = [&](const std::array<double, kSegmentVariables>& at) {
    SegmentValues<double> out;
    evaluate_segment(law, at, 0.2, 0.4, out);
    std::vector<double> all{out.energy_J[0], out.energy_J[1], out.duration_s};
    all.insert(all.end(), out.bounded.begin(), out.bounded.end());
    return all;
  };
  std::array<Jet, kSegmentVariables> variables;
  for (std::size_t i = 0; i < x.size(); ++i) variables[i] = Jet::variable(i, x[i]);
  SegmentValues<Jet> out;
  evaluate_segment(law, variables, 0.2, 0.4, out);
  std::vector<Jet> exact{out.energy_J[0], out.energy_J[1], out.duration_s};
  exact.insert(exact.end(), out.bounded.begin(), out.bounded.end());
  constexpr double h = 1e-4;
  const auto moved = [&](std::size_t i, double di, std::size_t j, double dj) {
    auto at = x;
    at[i] += di;
    at[j] += dj;
    return values(at);
  };
  for (std::size_t i = 0, k = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++k) {
      const auto pp = moved(i, h, j, h), pm = moved(i, h, j, -h), mp = moved(i, -h, j, h),
                 mm = moved(i, -h, j, -h);
      const auto up = moved(i, h, i, 0), down = moved(i, -h, i, 0);
      for (std::size_t f = 0; f < exact.size(); ++f) {
        EXPECT_NEAR(exact[f].dd[k], (pp[f] - pm[f] - mp[f] + mm[f]) / (4 * h * h),
                    2e-5 * (1 + std::abs(exact[f].dd[k])))
            << f << ": " << i << ", " << j;
        EXPECT_NEAR(exact[f].d[i], (up[f] - down[f]) / (2 * h), 1e-5 * (1 + std::abs(exact[f].d[i]))) << f;
      }
    }
}

// The law's power is the model's, also with a center of mass beside the axle.
TEST(JointSegment, PowerIsTheModels) {
  Robot robot = testing::nomad();
  robot.geometry.center_of_mass_offset_m = 0.07;
  const Plant plant = make_nominal_plant(robot);
  const DriveLaw law = drive_law(plant, limits_for_payload(robot, 3), 3, {}, 0);
  for (const BodyMotion<double>& motion :
       {BodyMotion<double>{0.7, 0.3, 0.4, -0.6}, BodyMotion<double>{0.1, -0.2, 1.2, 0.5}}) {
    const Site site = site_of(robot.geometry, {}, 3, motion.speed_m_s, motion.yaw_rate_rad_s);
    const auto wheels = operating_point(plant, motion, site);
    for (const Side side : kSides)
      EXPECT_NEAR(motor_power_W(law.wheel[side], motion, site.wheel_direction[side]), wheels[side].power_W,
                  1e-9);
  }
}

}  // namespace
}  // namespace joulepath::joint
