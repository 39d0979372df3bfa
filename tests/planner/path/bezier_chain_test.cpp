#include "planner/path/shape/bezier_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/planner/path/curve_laws.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;
using Kind = BezierFinding::Kind;

const BezierPoints kPaperCurve_m{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}};

Path chain_path(const std::vector<BezierPoints>& curves_m, const Pose& start = {},
                BezierFrame frame = BezierFrame::map) {
  const BezierChainResult result = bezier_chain(curves_m, start, frame);
  EXPECT_TRUE(result.ok());
  return result.path;
}

TEST(Bezier, ChannelsAreEachOthersIntegralsOnThePapersCurve) {
  const Path path = chain_path({kPaperCurve_m});
  ASSERT_EQ(path.pieces.size(), 1u);
  const CurveBreach breach = curve_breach(path.pieces[0], 2000);
  EXPECT_LT(breach.position_m, 1e-11);
  EXPECT_LT(breach.heading_rad, 1e-10);
  EXPECT_LT(breach.curvature_per_m, 1e-9);
  EXPECT_NEAR(path.end().x_m, 2.7, 1e-14);
  EXPECT_NEAR(path.end().y_m, 2.7, 1e-14);
  EXPECT_NEAR(path.end().heading_rad, pi / 2, 1e-13);
}

TEST(Bezier, ChannelsAreEachOthersIntegralsOnRandomCurves) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-2, 2);
  int checked = 0;
  while (checked < 60) {
    BezierPoints p{};
    for (auto& point : p) point = {coordinate(random), coordinate(random)};
    const auto result = bezier_chain({p}, {p[0][0], p[0][1], 0}, BezierFrame::map);
    if (!result.ok()) continue;
    const PathPiece& curve = result.path.pieces.back();
    double tightest_per_m = 0;
    for (int i = 0; i <= 2000; ++i)
      tightest_per_m = std::max(tightest_per_m,
                                std::abs(piece_point(curve, piece_length(curve) * i / 2000).curvature_per_m));
    if (tightest_per_m > 20) continue;  // the test's own quadrature would need finer steps
    const CurveBreach breach = curve_breach(curve, 4000);
    EXPECT_LT(breach.position_m, 1e-10);
    EXPECT_LT(breach.heading_rad, 1e-9);
    EXPECT_LT(breach.curvature_per_m, 1e-7);
    ++checked;
  }
}

TEST(Bezier, ArcLengthInvertsToTwelveDigits) {
  const BezierSegment curve(kPaperCurve_m);
  for (int i = 0; i <= 500; ++i) {
    const double t = i / 500.0;
    double s_m = 0;  // composite Simpson rule with many steps
    const int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const auto speed = [&](double x) {
        const auto d = bezier_derivatives(kPaperCurve_m, x).first_m;
        return std::hypot(d[0], d[1]);
      };
      const double a = t * k / steps, b = t * (k + 1) / steps;
      s_m += (b - a) / 6 * (speed(a) + 4 * speed(0.5 * (a + b)) + speed(b));
    }
    EXPECT_NEAR(curve.parameter(s_m), t, 2e-12);
  }
}

TEST(Bezier, QuarterCircleApproximationHasItsRadius) {
  // The usual handle 4/3 tan(pi/8) keeps the radius to 2.7e-4.
  const double k = 4.0 / 3.0 * std::tan(pi / 8);
  const Path path = chain_path({{{{1, 0}, {1, k}, {k, 1}, {0, 1}}}}, {1, 0, pi / 2});
  ASSERT_EQ(path.pieces.size(), 1u);
  EXPECT_NEAR(path.distance_m(), pi / 2, 4e-4);
  for (int i = 0; i <= 100; ++i) {
    const PathPoint p = piece_point(path.pieces[0], path.distance_m() * i / 100);
    EXPECT_NEAR(std::hypot(p.pose.x_m, p.pose.y_m), 1.0, 2.8e-4);
    EXPECT_NEAR(p.curvature_per_m, 1.0, 0.022);  // at the ends 2/3 (1 - k) / k^2 = 0.9786
  }
}

TEST(Bezier, CollinearControlPointsAreExactlyStraight) {
  const Path path = chain_path({{{{0, 0}, {0, 0}, {3, 4}, {3, 4}}}}, {0, 0, std::atan2(4, 3)});
  ASSERT_EQ(path.pieces.size(), 1u);
  EXPECT_DOUBLE_EQ(path.distance_m(), 5.0);
  EXPECT_EQ(piece_point(path.pieces[0], 2.2).curvature_per_m, 0.0);
}

TEST(BezierChain, StartFrameMovesTheCurveToTheRobot) {
  const Pose start{1, 2, pi / 2};
  const Path path = chain_path({kPaperCurve_m}, start, BezierFrame::start);
  ASSERT_EQ(path.pieces.size(), 1u);
  EXPECT_NEAR(path.end().x_m, 1 - 2.7, 1e-14);
  EXPECT_NEAR(path.end().y_m, 2 + 2.7, 1e-14);
  EXPECT_NEAR(wrapped_angle_rad(path.end().heading_rad - pi), 0, 1e-13);
}

TEST(BezierChain, TurnsInPlaceWhereTheHeadingBreaks) {
  const BezierPoints east{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}}, north{{{3, 0}, {3, 1}, {3, 2}, {3, 3}}};
  const auto result = bezier_chain({east, north}, {0, 0, pi}, BezierFrame::map);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result.path.pieces.size(), 4u);  // turn, east, turn, north
  EXPECT_NEAR(result.path.turned_rad(), 1.5 * pi, 1e-14);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_EQ(result.notes[0].kind, Kind::heading_step);
  EXPECT_NEAR(result.notes[0].amount, pi / 2, 1e-14);
  EXPECT_EQ(result.notes[0].x_m, 3.0);
}

TEST(BezierChain, StopsWhereOnlyCurvatureJumps) {
  const BezierPoints east{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}};
  const BezierPoints bend{{{3, 0}, {3.5, 0}, {4, 0.5}, {4, 1}}};
  const auto result = bezier_chain({east, bend}, {0, 0, 0}, BezierFrame::map);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.path.pieces.size(), 2u);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_EQ(result.notes[0].kind, Kind::curvature_step);
}

TEST(BezierChain, OneCurveWhereCurvatureIsContinuous) {
  // A cubic split at t = 0.4 by de Casteljau is the same curve twice.
  const BezierPoints p{{{0, 0}, {1, 0.2}, {2, 2}, {3, 0}}};
  const double t = 0.4;
  const auto mix = [t](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return std::array<double, 2>{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
  };
  const auto a = mix(p[0], p[1]), b = mix(p[1], p[2]), c = mix(p[2], p[3]);
  const auto d = mix(a, b), e = mix(b, c), f = mix(d, e);
  const Path whole = chain_path({p}), parts = chain_path({{{p[0], a, d, f}}, {{f, e, c, p[3]}}});
  ASSERT_EQ(parts.pieces.size(), whole.pieces.size());
  EXPECT_NEAR(parts.distance_m(), whole.distance_m(), 1e-12);
  EXPECT_EQ(piece_breakpoints(parts.pieces.back()).size(), 3u);
}

TEST(BezierChain, ReportsACuspWithItsPlace) {
  // p0 = (0,0), p1 = (1,1), p2 = (0,1)... the symmetric cubic whose handles cross just enough to stop.
  const BezierPoints cusp{{{0, 0}, {1, 1}, {0, 1}, {1, 0}}};
  const auto defects = bezier_defects(cusp, 3);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].kind, Kind::cusp);
  EXPECT_EQ(defects[0].curve, 3u);
  EXPECT_NEAR(defects[0].t, 0.5, 1e-6);
  EXPECT_NEAR(defects[0].x_m, 0.5, 1e-6);
  EXPECT_NEAR(defects[0].y_m, 0.75, 1e-6);
}

TEST(BezierChain, ReportsAStandstillThatDoesNotTurnBack) {
  const auto defects = bezier_defects({{{0, 0}, {1.0 / 3, 1e-4}, {-1.0 / 3, 3e-4}, {1, 1e-4}}}, 0);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].kind, Kind::cusp);
  EXPECT_NEAR(defects[0].t, 1.0 / 3, 1e-3);
}

TEST(BezierChain, ReportsTurningBackOnALine) {
  const auto defects = bezier_defects({{{0, 0}, {3, 0}, {-2, 0}, {1, 0}}}, 0);
  ASSERT_EQ(defects.size(), 2u);
  EXPECT_EQ(defects[0].kind, Kind::cusp);
  EXPECT_EQ(bezier_defects({{{0, 0}, {1, 0}, {1, 0}, {0, 0}}}, 0).size(), 1u);
  EXPECT_EQ(bezier_defects({{{1, 0}, {0, 0}, {2, 0}, {1, 0}}}, 0).size(), 2u);  // the handles cancel
}

TEST(BezierChain, ReportsOtherDefects) {
  const double nan = std::nan("");
  EXPECT_EQ(bezier_defects({{{0, 0}, {nan, 0}, {1, 0}, {2, 0}}}, 0).at(0).kind, Kind::not_finite);
  EXPECT_EQ(bezier_defects({{{1, 1}, {1, 1}, {1, 1}, {1, 1}}}, 0).at(0).kind, Kind::no_length);
  EXPECT_EQ(bezier_defects({{{0, 0}, {0, 0}, {1, 1}, {2, 0}}}, 0).at(0).kind, Kind::unbounded_curvature);
  const auto gap = bezier_chain({kPaperCurve_m}, {0.5, 0, 0}, BezierFrame::map);
  ASSERT_EQ(gap.defects.size(), 1u);
  EXPECT_EQ(gap.defects[0].kind, Kind::gap);
  EXPECT_NEAR(gap.defects[0].amount, 0.5, 1e-15);
  EXPECT_TRUE(gap.path.pieces.empty());
}

}  // namespace
}  // namespace joulepath
