#pragma once

#include <cmath>
#include <random>

#include "planner/values/profile_request.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

enum class PathClass { straight, bezier, corners, tight_corners };
inline constexpr PathClass kPathClasses[] = {PathClass::straight, PathClass::bezier, PathClass::corners,
                                             PathClass::tight_corners};
inline constexpr const char* kPathClassNames[] = {"straight", "bezier", "corners", "tight corners"};

/// Seeded random problems as in the benchmark: four classes of path, payload 0 to 10.5 kg, regeneration
/// 0, 0.6 or 1, standby 2, 10 or 20 W. The time goal is left at free_time.
class RandomProfiles {
 public:
  explicit RandomProfiles(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  int choice(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

  ProfileRequest next(PathClass path_class) {
    Robot robot = nomad();
    const double standby_W[] = {2, 10, 20}, eta[] = {0, 0.6, 1};
    robot.power.standby_W = standby_W[choice(3)];
    robot.power.regeneration_efficiency = eta[choice(3)];
    robot.power.sharing = choice(2) == 0 ? PowerSharing::wheel : PowerSharing::bus;
    const double payload_kg = uniform(0, 10.5);
    return {.piece = piece(path_class),
            .plant = make_plant(robot),
            .limits = *robot.limits,
            .payload = {payload_kg, payload_kg}};
  }

 private:
  PathPiece piece(PathClass path_class) {
    switch (path_class) {
      case PathClass::straight:
        return straight_piece({}, uniform(1, 40));
      case PathClass::bezier:
        return bezier();
      case PathClass::corners:
        return corners(uniform(0.4, 1.5));
      case PathClass::tight_corners:
        break;
    }
    return corners(uniform(0.09, 0.16));  // below half the track of 0.165 m: the inner wheel reverses
  }

  PathPiece bezier() {
    const double size = uniform(2, 10), turn = uniform(-1.6, 1.6);
    const double reach = size * uniform(0.3, 0.5);
    const double x = size * std::cos(turn / 2), y = size * std::sin(turn / 2);
    return Curve({BezierSegment(
        {{{0, 0}, {reach, 0}, {x - reach * std::cos(turn), y - reach * std::sin(turn)}, {x, y}}})});
  }

  /// Straights joined by clothoid pairs: curvature rises linearly to 1/radius and falls again.
  PathPiece corners(double radius_m) {
    std::vector<CurveSegment> segments;
    Pose pose{};
    const auto append = [&](double length_m, double curvature, double slope) {
      segments.emplace_back(LinearCurvature(pose, length_m, curvature, slope));
      pose = std::get<LinearCurvature>(segments.back()).at(length_m).pose;
    };
    append(uniform(0.5, 5), 0, 0);
    const int count = 1 + choice(4);
    for (int i = 0; i < count; ++i) {
      const double turn = (choice(2) == 0 ? 1 : -1) * uniform(0.4, 1.6);
      const double ramp_m = std::abs(turn) * radius_m, peak = std::copysign(1 / radius_m, turn);
      append(ramp_m, 0, peak / ramp_m);
      append(ramp_m, peak, -peak / ramp_m);
      append(uniform(0.5, 5), 0, 0);
    }
    return Curve(std::move(segments));
  }

  std::mt19937 random_;
};

}  // namespace joulepath::testing
