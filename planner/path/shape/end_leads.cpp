#include "planner/path/shape/end_leads.hpp"

#include <cmath>

namespace joulepath {
namespace {

constexpr double kLeads_m[] = {0.3, 0.5, 0.8, 1.2, 1.8};

bool better(const Path& path, const Path& best) {
  const double less_rad = best.turned_rad() - path.turned_rad();
  return less_rad > 1e-9 || (less_rad > -1e-9 && path.distance_m() < best.distance_m());
}

/// The best length of one lead, for a given length of the other.
std::optional<SmoothPath> best_lead(const std::vector<Point2>& polyline_m, bool at_start, double heading_rad,
                                    const FootprintChecker& checker, const CornerPolicy& policy) {
  std::optional<SmoothPath> best;
  for (const double length_m : kLeads_m) {
    const Lead lead{heading_rad, length_m};
    auto blended = at_start ? blend_with_leads(polyline_m, lead, std::nullopt, checker, policy)
                            : blend_with_leads(polyline_m, std::nullopt, lead, checker, policy);
    if (blended && (!best || better(blended->path, best->path))) best = std::move(blended);
  }
  return best;
}

bool differ(double a_rad, double b_rad) { return std::abs(wrapped_angle_rad(a_rad - b_rad)) > 1e-6; }

/// The polyline with the leads' outer ends as new vertices. Requires two vertices.
std::vector<Point2> with_leads(const std::vector<Point2>& polyline_m, const std::optional<Lead>& start,
                               const std::optional<Lead>& goal) {
  std::vector<Point2> led = polyline_m;
  if (start)
    led.insert(led.begin() + 1, {polyline_m.front()[0] + start->length_m * std::cos(start->heading_rad),
                                 polyline_m.front()[1] + start->length_m * std::sin(start->heading_rad)});
  if (goal)
    led.insert(led.end() - 1, {polyline_m.back()[0] - goal->length_m * std::cos(goal->heading_rad),
                               polyline_m.back()[1] - goal->length_m * std::sin(goal->heading_rad)});
  return led;
}

}  // namespace

std::optional<SmoothPath> blend_with_leads(const std::vector<Point2>& polyline_m,
                                           const std::optional<Lead>& start, const std::optional<Lead>& goal,
                                           const FootprintChecker& checker, const CornerPolicy& policy) {
  SmoothPath blended = blend_corners(with_leads(polyline_m, start, goal), checker, policy);
  const bool start_turns = start && blended.corners.front().radius_m == 0;
  const bool goal_turns = goal && blended.corners.back().radius_m == 0;
  if (start_turns || goal_turns || checker.first_collision(blended.path)) return std::nullopt;
  return blended;
}

std::optional<SmoothPath> blend_along_headings(const std::vector<Point2>& polyline_m,
                                               const std::optional<double>& start_heading_rad,
                                               const std::optional<double>& goal_heading_rad,
                                               const FootprintChecker& checker, const CornerPolicy& policy) {
  std::optional<SmoothPath> blended = blend_corners(polyline_m, checker, policy);
  if (polyline_m.size() < 2 || policy.kind == CornerPolicy::Kind::stop_turn_go) return blended;
  if (start_heading_rad && differ(blended->path.start().heading_rad, *start_heading_rad))
    if (auto led = best_lead(blended->polyline_m, true, *start_heading_rad, checker, policy)) blended = led;
  if (goal_heading_rad && differ(blended->path.end().heading_rad, *goal_heading_rad))
    if (auto led = best_lead(blended->polyline_m, false, *goal_heading_rad, checker, policy)) blended = led;
  return blended;
}

}  // namespace joulepath
