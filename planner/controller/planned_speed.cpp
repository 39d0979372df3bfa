#include "planner/controller/planned_speed.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

/// Length of a stretch in the leg's arc length.
double length_m(const StretchPlan& stretch) {
  return is_turn(stretch.request.piece) ? 0.0 : piece_length(stretch.request.piece);
}

/// Highest rate of a profile on [from, to] of its path coordinate.
double highest_rate(const Profile& profile, double from, double to) {
  double highest = std::max(profile.at_s(from).rate, profile.at_s(to).rate);
  for (std::size_t k = 0; k < profile.s.size(); ++k)
    if (profile.s[k] > from && profile.s[k] < to) highest = std::max(highest, profile.rate[k]);
  return highest;
}

/// Highest planned speed (m/s) between two places of a leg; 0 where there are only turns between them.
double highest_speed_m_s(const LegPlan& leg, double from_m, double to_m) {
  double highest = 0, begin_m = 0;
  for (const StretchPlan& stretch : leg.stretches) {
    const double end_m = begin_m + length_m(stretch);
    const double from = std::max(from_m, begin_m) - begin_m, to = std::min(to_m, end_m) - begin_m;
    if (from < to) highest = std::max(highest, highest_rate(stretch.profile, from, to));
    begin_m = end_m;
  }
  return highest;
}

}  // namespace

std::vector<PathPart> leg_parts(const LegPlan& leg) {
  if (!leg.parts.empty()) return leg.parts;
  std::vector<PathPart> parts;
  double begin_m = 0;
  for (const StretchPlan& stretch : leg.stretches) {
    if (is_turn(stretch.request.piece)) continue;
    const std::vector<double> breaks_m = piece_breakpoints(stretch.request.piece);
    for (std::size_t k = 0; k + 1 < breaks_m.size(); ++k)
      parts.push_back({"", begin_m + breaks_m[k], begin_m + breaks_m[k + 1]});
    begin_m += length_m(stretch);
  }
  return parts;
}

PartSpeeds part_speeds(const Plan& plan, double scale) {
  constexpr double kStep_m_s = 1e-3;
  PartSpeeds speeds;
  for (const LegPlan& leg : plan.legs) {
    speeds.emplace_back();
    for (const PathPart& part : leg_parts(leg))
      speeds.back().push_back(
          kStep_m_s * std::ceil(scale * highest_speed_m_s(leg, part.from_m, part.to_m) / kStep_m_s - 1e-9));
  }
  return speeds;
}

std::vector<SpeedCap> caps_on(const PartSpeeds& speeds, const StretchPlace& place, const StretchPlan& stretch,
                              const LegPlan& leg) {
  const std::vector<PathPart> parts = leg_parts(leg);
  const double length = length_m(stretch);
  std::vector<SpeedCap> caps;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double from_m = std::max(0.0, parts[k].from_m - place.from_m);
    const double to_m = std::min(length, parts[k].to_m - place.from_m);
    if (from_m < to_m) caps.push_back({from_m, to_m, speeds[place.leg][k]});
  }
  return caps;
}

double scale_for_plan_time(const Plan& plan, const std::function<ControlledDrive(double)>& drive) {
  constexpr int kHalvings = 9;  // to 1/500: caps are given in mm/s or hundredths
  if (drive(1.0).duration_s >= plan.duration_s) return 1.0;
  double low = 0.2, high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (drive(middle).duration_s > plan.duration_s ? low : high) = middle;
  }
  return high;
}

}  // namespace joulepath
