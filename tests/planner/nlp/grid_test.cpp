#include "planner/nlp/transcription/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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
  for (int trial = 0; trial < 80; ++trial) {
    const BezierPoints points_m{{{0, 0},
                                 {0.3 * coordinate(random), 0.3 * coordinate(random)},
                                 {coordinate(random), coordinate(random)},
                                 {2, coordinate(random)}}};
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

}  // namespace
}  // namespace joulepath::nlp
