#include "extensions/nav2/corner_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/motion/motion_energy.hpp"
#include "planner/path/shape/corner_blend.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath {
namespace {

constexpr int kHalf = 36;     ///< angles from 0 to pi
constexpr int kDrivenOn = 1;  ///< number of angles at which the robot does not stop
constexpr std::size_t kNodes = 60;
constexpr double kSmaller = 0.9;  ///< next radius to try where one does not fit

/// Energy and time of a path whose pieces are each driven from rest to rest in the time of least energy.
class DriveCost {
 public:
  DriveCost(const Plant& plant, const Limits& limits, double payload_kg)
      : plant_(plant), limits_(limits), payload_kg_(payload_kg) {}

  CornerTable::Cost of(const Path& path) const {
    CornerTable::Cost cost;
    for (const PathPiece& piece : path.pieces) {
      ProfileRequest request{.piece = piece,
                             .plant = plant_,
                             .limits = limits_,
                             .payload = {payload_kg_, payload_kg_},
                             .nodes = kNodes,
                             .solver = SolverChoice::fast};
      const ProfileResult result = solve_profile(request);
      if (!result.profile) return {kNoLimit, kNoLimit};
      cost.energy_J += energy_by_cause(path_motion(request), *result.profile).total_J();
      cost.time_s += result.profile->duration_s();
    }
    return cost;
  }

 private:
  const Plant& plant_;
  const Limits& limits_;
  double payload_kg_{};
};

std::vector<Point2> corner_points(double angle_rad, double leg_m) {
  return {{-leg_m, 0}, {0, 0}, {leg_m * std::cos(angle_rad), leg_m * std::sin(angle_rad)}};
}

bool arc_fits(double angle_rad, double radius_m, double leg_m) {
  return !lines_between(corner_points(angle_rad, leg_m), {0, radius_m, 0}).defect;
}

/// With an arc of the radius, or of the largest one that fits; else with a turn in place.
Path corner_path(double angle_rad, double radius_m, double leg_m) {
  const bool back = std::abs(angle_rad) >= std::numbers::pi - 1e-6;
  for (double radius = back ? 0.0 : radius_m; radius >= kLeastCornerRadius_m; radius *= kSmaller)
    if (const WaypointPath way = lines_between(corner_points(angle_rad, leg_m), {0, radius, 0}); !way.defect)
      return way.path;
  Path path{{straight_piece({-leg_m, 0, 0}, leg_m)}};
  append_turn_to(path, path.end(), angle_rad);
  path.pieces.push_back(straight_piece({0, 0, angle_rad}, leg_m));
  return path;
}

}  // namespace

CornerTable::CornerTable(const Plant& plant, const Limits& limits, double payload_kg, double radius_m,
                         double leg_m) {
  const DriveCost drive(plant, limits, payload_kg);
  const Cost straight = drive.of({{straight_piece({-leg_m, 0, 0}, 2 * leg_m)}});
  for (int i = -kHalf; i <= kHalf; ++i) {
    if (std::abs(i) <= kDrivenOn) {
      costs_.push_back({});
      continue;
    }
    const Cost corner = drive.of(corner_path(i * std::numbers::pi / kHalf, radius_m, leg_m));
    costs_.push_back({corner.energy_J - straight.energy_J, corner.time_s - straight.time_s});
  }
  const auto angle = [](int i) { return i * std::numbers::pi / kHalf; };
  int fits = kHalf;
  if (radius_m > 0)
    for (fits = kDrivenOn; fits + 1 < kHalf && arc_fits(angle(fits + 1), radius_m, leg_m);) ++fits;
  fits_up_to_rad_ = angle(fits);
}

CornerTable::Cost CornerTable::at(double angle_rad) const {
  const double place = std::clamp(angle_rad / std::numbers::pi * kHalf + kHalf, 0.0, 2.0 * kHalf);
  const auto k = std::min(static_cast<std::size_t>(place), costs_.size() - 2);
  const double share = place - static_cast<double>(k);
  const auto mix = [&](double a, double b) { return a + share * (b - a); };
  return {mix(costs_[k].energy_J, costs_[k + 1].energy_J), mix(costs_[k].time_s, costs_[k + 1].time_s)};
}

}  // namespace joulepath
