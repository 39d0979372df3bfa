#include "planner/nlp/transcription/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planner/nlp/transcription/chord_of_caps.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/rate_cap.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::nlp {
namespace {

/// Places where the slower wheel of a robot begins or ends to run backwards on a curve, 1 - l |kappa| < 0,
/// for at least a twentieth of the curve's length: places on a fine raster, then bisection.
std::vector<double> reversals_m(const Curve& curve, double half_track_m) {
  const auto backwards = [&](double s_m) {
    return half_track_m * std::abs(curve.at(s_m).curvature_per_m) > 1;
  };
  constexpr int kRaster = 997;
  std::vector<double> places_m;
  double begin_m = 0;
  for (int i = 0; i < kRaster; ++i) {
    double low_m = curve.length_m() * i / kRaster, high_m = curve.length_m() * (i + 1) / kRaster;
    const bool begins = backwards(high_m);
    if (backwards(low_m) == begins) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle_m = 0.5 * (low_m + high_m);
      (backwards(middle_m) == begins ? high_m : low_m) = middle_m;
    }
    if (!begins && high_m - begin_m > 0.05 * curve.length_m()) {
      if (begin_m > 0) places_m.push_back(begin_m);
      places_m.push_back(high_m);
    }
    begin_m = high_m;
  }
  return places_m;
}

TEST(MandatoryNodes, AreWhereAWheelReverses) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const Plant plant = make_plant(testing::nomad());
  std::size_t reversals = 0;
  for (int trial = 0; trial < 120; ++trial) {
    BezierPoints points_m{{{0, 0},
                           {0.3 * coordinate(random), 0.3 * coordinate(random)},
                           {coordinate(random), coordinate(random)},
                           {2, coordinate(random)}}};
    if (trial >= 80)  // on a short curve as exactly, of its length
      for (auto& point_m : points_m)
        for (double& x_m : point_m) x_m *= 0.05;
    const Curve curve({BezierSegment(points_m)});
    const ProfileRequest request{.piece = curve, .plant = plant};
    const std::vector<double> nodes = mandatory_nodes(PathMotion(request.piece, request.plant, {}), request);
    for (const double place_m : reversals_m(curve, plant.robot.geometry.half_track_m)) {
      double nearest_m = kNoLimit;
      for (const double node : nodes) nearest_m = std::min(nearest_m, std::abs(node - place_m));
      EXPECT_LT(nearest_m, 1e-9 * curve.length_m()) << trial << ": " << place_m;
      ++reversals;
    }
  }
  EXPECT_GT(reversals, 20u);
}

/// 8 m straight, slower up than down.
ProfileRequest straight_drive() {
  Robot robot = testing::nomad();
  robot.limits->acceleration_m_s2 = 0.4;
  robot.limits->deceleration_m_s2 = 0.6;
  return {.piece = straight_piece({}, 8.0), .plant = make_plant(robot), .limits = *robot.limits};
}

ProfileRequest bent_drive() {
  ProfileRequest request = straight_drive();
  request.piece = Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})});
  return request;
}

/// 1/u^2 is the sum of the inverse squares of the ramps from both ends and of the cap.
TEST(ReferenceRate, IsASmoothMinimumOfTheRampsAndTheCap) {
  const ProfileRequest request = straight_drive();
  for (const double s : {0.5, 3.0, 7.0})
    EXPECT_NEAR(1 / std::pow(reference_rate(request, 8.0, s, 0.25), 2),
                1 / (2 * 0.4 * s) + 1 / (2 * 0.6 * (8.0 - s)) + 1 / 0.25, 1e-9)
        << s;
}

/// 8 m in 30 s by a parabola: 0.4 m/s at most, which a cap of 0.3 m/s does not permit.
TEST(ReferenceRate, IsTheParabolaOfAGivenTimeWhereTheCapPermitsIt) {
  ProfileRequest request = straight_drive();
  request.time = {TimeMode::fixed_time, 30.0};
  for (const double tau : {0.1, 0.4, 0.5, 0.9}) {
    const double s = 8.0 * tau * tau * (3 - 2 * tau);
    EXPECT_NEAR(reference_rate(request, 8.0, s, 1.0), 6 * 8.0 / 30.0 * tau * (1 - tau), 1e-9) << tau;
    EXPECT_LT(reference_rate(request, 8.0, s, 0.09), 0.3) << tau;
  }
}

/// A node that has to be in the middle of a drive that is the same from both ends leaves it so.
TEST(Grid, OfASymmetricDriveIsSymmetric) {
  ProfileRequest request = straight_drive();
  request.limits.acceleration_m_s2 = request.limits.deceleration_m_s2;
  request.speed_caps = {{4.0, 8.0, 10.0}};
  const std::vector<double> grid = make_grid(path_motion(request), request, 40);
  EXPECT_EQ(std::count(grid.begin(), grid.end(), 4.0), 1);
  EXPECT_NEAR(static_cast<double>(grid.size()), 41, 2);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_NEAR(grid[i] + grid[grid.size() - 1 - i], 8.0, 1e-6);
}

/// At least half of the nodes follow the time: no segment lasts longer than two of a grid of equal times.
TEST(Grid, OfABendKeepsHalfOfItsNodesForTheTime) {
  const ProfileRequest request = bent_drive();
  const PathMotion motion = path_motion(request);
  const auto time_s = [&](double from_m, double to_m) {
    constexpr int kParts = 50;
    double sum_s = 0;
    for (int i = 0; i < kParts; ++i) {
      const double s = from_m + (to_m - from_m) * (i + 0.5) / kParts;
      const double cap = rate_cap_squared(request, motion.rates(s), s);
      sum_s += (to_m - from_m) / kParts / reference_rate(request, motion.length(), s, cap);
    }
    return sum_s;
  };
  constexpr int kNodes = 60;
  const std::vector<double> grid = make_grid(motion, request, kNodes);
  double total_s = 0, longest_s = 0;
  for (std::size_t k = 0; k + 1 < grid.size(); ++k) {
    total_s += time_s(grid[k], grid[k + 1]);
    longest_s = std::max(longest_s, time_s(grid[k], grid[k + 1]));
  }
  EXPECT_NEAR(static_cast<double>(grid.size()), kNodes + 1, 2);
  EXPECT_LT(longest_s, 2.1 * total_s / kNodes);
}

/// Between nodes the square of the rate is a chord: for every division of a curve into equal segments it is
/// below the caps inside. Returns whether the chord of the ends' own caps is not.
bool lowers_dips(const ProfileRequest& request) {
  const PathMotion motion = path_motion(request);
  const auto cap_at = [&](double s) { return rate_cap_squared(request, motion.rates(s), s); };
  bool dips = false;
  for (int count = 1; count < 9; ++count)
    for (int k = 0; k < count; ++k) {
      const double ds = motion.length() / count, s0 = k * ds, s1 = s0 + ds;
      RateCap cap0, cap1;
      lower_caps(request, motion, make_segment(request, motion, s0, s1, nullptr), {}, cap0, cap1);
      double least = std::min(cap_at(s0), cap_at(s1));
      for (const double f : kInsideSegment) {
        const double inside = cap_at(s0 + f * ds);
        EXPECT_LE((1 - f) * cap0.squared + f * cap1.squared, inside * (1 + 1e-9)) << count << " " << k;
        dips = dips || inside < 0.9 * ((1 - f) * cap_at(s0) + f * cap_at(s1));
        least = std::min(least, inside);
      }
      EXPECT_GE(std::min(cap0.squared, cap1.squared), 0.5 * least * (1 - 1e-9)) << count << " " << k;
    }
  return dips;
}

TEST(LowerCaps, KeepTheChordBelowTheCapsInside) {
  ProfileRequest request = bent_drive();
  request.piece = Curve({BezierSegment({{{0, 0}, {2.5, 0}, {2.7, 0.2}, {2.7, 2.7}}})});
  EXPECT_TRUE(lowers_dips(request));
}

/// Caps inside at fifths of the length, any of which may be far below the ends'.
TEST(ChordOfCaps, IsBelowEveryCapInside) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.05, 1);
  for (int i = 0; i < 1000; ++i) {
    const CapsInside inside{any(random), any(random), any(random), any(random)};
    const ChordOfCaps chord = chord_of_caps(any(random), any(random), inside);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const double share = 0.2 * static_cast<double>(k + 1);
      EXPECT_LE((1 - share) * chord.squared[0] + share * chord.squared[1], inside[k] * (1 + 1e-12)) << i;
    }
  }
}

/// Limits hold at both ends of a segment and in its middle.
TEST(Segments, HaveTheirLimitsAtEndsAndMiddle) {
  const ProfileRequest request = bent_drive();
  const PathMotion motion = path_motion(request);
  const Problem problem = transcribe(request, motion, make_grid(motion, request, 20), {}, nullptr);
  for (const Segment& segment : problem.segments) {
    EXPECT_EQ(segment.limit_points[0].fraction, 0.0);
    EXPECT_EQ(segment.limit_points[1].fraction, 0.5);
    EXPECT_EQ(segment.limit_points[2].fraction, 1.0);
  }
}

/// No limit of speed: nothing bounds the rate at the straight start.
TEST(LowerCaps, BoundASegmentThatBeginsWithoutABound) {
  ProfileRequest request = bent_drive();
  request.limits.speed_m_s = request.limits.yaw_rate_rad_s = kNoLimit;
  for (const double end_m : {0.5, 1.0, 1.5, 2.0, 2.5}) {
    request.piece = Curve({BezierSegment({{{0, 0}, {1, 0}, {2, 0}, {2.0 + end_m, end_m}}})});
    EXPECT_TRUE(lowers_dips(request));
  }
}

}  // namespace
}  // namespace joulepath::nlp
