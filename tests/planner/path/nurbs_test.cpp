#include "planner/path/geometry/nurbs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "planner/path/geometry/quintic_fit.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

double length_of(const CurveSegment& segment) {
  return std::visit([](const auto& s) { return s.length_m(); }, segment);
}
PathPoint point_of(const CurveSegment& segment, double s_m) {
  return std::visit([s_m](const auto& s) { return s.at(s_m); }, segment);
}

/// The circle of nine control points: quadratic, double inner knots, weights 1 and 1/sqrt(2).
Nurbs circle(double radius_m, double x_m, double y_m) {
  const double corner = std::numbers::sqrt2 / 2;
  const double places[9][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  Nurbs nurbs{.degree = 2, .knots = {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1}};
  for (std::size_t i = 0; i < 9; ++i) {
    const double w = i % 2 ? corner : 1.0;
    nurbs.points.push_back({w * (x_m + radius_m * places[i][0]), w * (y_m + radius_m * places[i][1]), w});
  }
  return nurbs;
}

/// Basis functions by their definition (Cox and de Boor), as an independent evaluation.
double basis(const std::vector<double>& u, std::size_t i, std::size_t p, double t) {
  if (p == 0) return t >= u[i] && t < u[i + 1] ? 1 : 0;
  double sum = 0;
  if (u[i + p] > u[i]) sum += (t - u[i]) / (u[i + p] - u[i]) * basis(u, i, p - 1, t);
  if (u[i + p + 1] > u[i + 1])
    sum += (u[i + p + 1] - t) / (u[i + p + 1] - u[i + 1]) * basis(u, i + 1, p - 1, t);
  return sum;
}

Nurbs random_nurbs(std::mt19937& random, std::size_t degree, std::size_t count) {
  std::uniform_real_distribution<double> number(0.2, 2.0);
  Nurbs nurbs{.degree = degree};
  double knot = 0;
  for (std::size_t i = 0; i < count + degree + 1; ++i) nurbs.knots.push_back(knot += number(random));
  for (std::size_t i = 0; i < count; ++i) {
    const double w = number(random);
    nurbs.points.push_back({w * (static_cast<double>(i) + number(random)), w * number(random), w});
  }
  return nurbs;
}

TEST(Nurbs, RationalCircleHasItsRadiusCurvatureAndLength) {
  constexpr double kRadius_m = 1.7, kX_m = -3, kY_m = 12;
  double around_m = 0;
  for (const RationalBezier& piece : bezier_pieces(circle(kRadius_m, kX_m, kY_m))) {
    const CurveSegment segment = segment_of(piece);
    const double length_m = length_of(segment);
    around_m += length_m;
    for (int i = 0; i <= 40; ++i) {
      const PathPoint point = point_of(segment, length_m * i / 40);
      EXPECT_NEAR(std::hypot(point.pose.x_m - kX_m, point.pose.y_m - kY_m), kRadius_m, 1e-12);
      EXPECT_NEAR(point.curvature_per_m, 1 / kRadius_m, 1e-10);
      EXPECT_NEAR(point.curvature_slope_per_m2, 0, 1e-8);
    }
  }
  EXPECT_NEAR(around_m, 2 * pi * kRadius_m, 1e-10);
}

TEST(Nurbs, PiecesAreTheCurveThatTheBasisFunctionsDefine) {
  std::mt19937 random(7);
  for (std::size_t degree = 1; degree <= 5; ++degree) {
    const Nurbs nurbs = random_nurbs(random, degree, degree + 4);
    const auto pieces = bezier_pieces(nurbs);
    ASSERT_EQ(pieces.size(), 4u);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const double from = nurbs.knots[degree + k], to = nurbs.knots[degree + k + 1];
      for (double t : {0.0, 0.3, 0.85}) {
        RationalBezier::Point sum{};
        for (std::size_t i = 0; i < nurbs.points.size(); ++i)
          for (std::size_t axis = 0; axis < 3; ++axis)
            sum[axis] += basis(nurbs.knots, i, degree, from + t * (to - from)) * nurbs.points[i][axis];
        const auto place_m = bezier_derivatives(pieces[k], t).position_m;
        EXPECT_NEAR(place_m[0], sum[0] / sum[2], 1e-11);
        EXPECT_NEAR(place_m[1], sum[1] / sum[2], 1e-11);
      }
    }
  }
}

TEST(Nurbs, DerivativesAreThoseOfDifferences) {
  std::mt19937 random(3);
  const RationalBezier piece = bezier_pieces(random_nurbs(random, 4, 5)).front();
  constexpr double kStep = 1e-4;
  for (double t : {0.2, 0.5, 0.8}) {
    const auto before = bezier_derivatives(piece, t - kStep), at = bezier_derivatives(piece, t),
               after = bezier_derivatives(piece, t + kStep);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(at.first_m[i], (after.position_m[i] - before.position_m[i]) / (2 * kStep), 1e-5);
      EXPECT_NEAR(at.second_m[i], (after.first_m[i] - before.first_m[i]) / (2 * kStep), 1e-4);
      EXPECT_NEAR(at.third_m[i], (after.second_m[i] - before.second_m[i]) / (2 * kStep), 1e-3);
    }
  }
}

TEST(Nurbs, SimpleKnotsOfACubicKeepCurvatureContinuous) {
  std::mt19937 random(11);
  const auto pieces = bezier_pieces(random_nurbs(random, 3, 7));
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const CurveSegment one = segment_of(pieces[k]), next = segment_of(pieces[k + 1]);
    EXPECT_NEAR(point_of(one, length_of(one)).curvature_per_m, point_of(next, 0).curvature_per_m, 1e-9);
  }
}

TEST(Nurbs, PointsOnALineAreAStraightSegment) {
  const Nurbs nurbs{
      .degree = 3, .knots = {0, 0, 0, 0, 1, 1, 1, 1}, .points = {{0, 0, 1}, {2, 2, 2}, {2, 2, 1}, {3, 3, 1}}};
  const auto pieces = bezier_pieces(nurbs);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<LinearCurvature>(segment_of(pieces.front())));
}

TEST(Nurbs, ACuspHasNoSpeed) {
  const RationalBezier cusp{{{0, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 1}}};
  EXPECT_LT(least_speed(cusp), 1e-9);
  EXPECT_GT(least_speed(bezier_pieces(circle(1, 0, 0)).front()), 0.1);
}

TEST(QuinticFit, MeetsAClothoidAtItsEndsAndStaysBesideIt) {
  const LinearCurvature clothoid({1, 2, 0.3}, 2.0, 0, 0.9);
  const Curve curve({clothoid});
  constexpr double kTolerance_m = 1e-3;
  const auto pieces = quintic_fit(curve, 0, 2.0, kTolerance_m);
  double from_m = 0, length_m = 0;
  for (const RationalBezier& piece : pieces) length_m += length_of(segment_of(piece));
  EXPECT_NEAR(length_m, 2.0, kTolerance_m);
  for (const RationalBezier& piece : pieces) {
    const CurveSegment segment = segment_of(piece);
    const double piece_m = 2.0 / static_cast<double>(pieces.size());
    const PathPoint begin = curve.at(from_m), end = curve.at(from_m + piece_m);
    EXPECT_NEAR(point_of(segment, 0).curvature_per_m, begin.curvature_per_m, 1e-9);
    EXPECT_NEAR(point_of(segment, length_of(segment)).curvature_per_m, end.curvature_per_m, 1e-9);
    EXPECT_NEAR(point_of(segment, 0).pose.heading_rad, begin.pose.heading_rad, 1e-9);
    for (int i = 0; i <= 37; ++i) {
      const Pose found = point_of(segment, length_of(segment) * i / 37).pose;
      const Pose wanted = curve.at(from_m + piece_m * i / 37).pose;
      EXPECT_LT(std::hypot(found.x_m - wanted.x_m, found.y_m - wanted.y_m), kTolerance_m);
    }
    from_m += piece_m;
  }
}

/// Within 1 mm of a curve that turns by 1.2 rad on 3 cm lie curves that turn quite otherwise.
TEST(QuinticFit, TurnsAsAShortTightCurveDoes) {
  constexpr double kLength_m = 0.03;
  const Curve curve({LinearCurvature({0, 0, 0.4}, kLength_m, 75, -5)});
  const auto pieces = quintic_fit(curve, 0, kLength_m, 1e-3);
  const double piece_m = kLength_m / static_cast<double>(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const CurveSegment segment = segment_of(pieces[k]);
    EXPECT_NEAR(length_of(segment), piece_m, 1e-3 * piece_m);
    for (int i = 0; i <= 37; ++i) {
      const double wanted_rad = curve.at(piece_m * (static_cast<double>(k) + i / 37.0)).pose.heading_rad;
      EXPECT_NEAR(point_of(segment, length_of(segment) * i / 37).pose.heading_rad, wanted_rad, 1.1e-3);
    }
  }
}

}  // namespace
}  // namespace joulepath
