#include "planner/confidence/lateness.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/limit_check.hpp"

namespace joulepath {
namespace {

constexpr double kSaturated = 1 + 1e-6;  ///< use of a limit
constexpr int kHalvings = 14;
constexpr int kSteps = 4;  ///< of a segment of the profile

/// One stretch, driven by another plant.
class SaturatedDrive {
 public:
  SaturatedDrive(const ProfileRequest& request, const Plant& plant, const Limits& limits)
      : motion_(request.piece, plant, request.payload, request.time_of_day_s, request.memory),
        limits_(limits) {}

  /// The greatest acceleration, at most the wanted one, from a squared rate over a distance of s.
  double acceleration(double s, double ds, double square, double wanted) const {
    if (wanted < 0 || holds(s, ds, square, wanted)) return wanted;
    double low = gentle(s, ds, square), high = wanted;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(s, ds, square, middle) ? low : high) = middle;
    }
    return low;
  }

 private:
  /// An acceleration of at most 0 that saturates nothing: none, or the least braking in powers of two; a stop
  /// where all of them do.
  double gentle(double s, double ds, double square) const {
    constexpr double kLeast = 0x1p-12;
    const double stop = -0.5 * square / ds;
    if (holds(s, ds, square, 0)) return 0;
    for (double share = kLeast; share < 1; share *= 2)
      if (holds(s, ds, square, share * stop)) return share * stop;
    return stop;
  }

  bool holds(double s, double ds, double square, double acceleration) const {
    const double rate = std::sqrt(std::max(0.0, square + acceleration * ds));
    bool all = true;
    for_each_limit_use(motion_, limits_, {}, {.s = s + 0.5 * ds, .rate = rate, .acceleration = acceleration},
                       0.0, [&](std::string_view, double use) { all &= use <= kSaturated; });
    return all;
  }

  PathMotion motion_;
  Limits limits_;
};

double segment_s(double ds, double square, double next) {
  return 2 * ds / (std::sqrt(square) + std::sqrt(next));
}

}  // namespace

double lateness_s(const StretchPlan& stretch, const Plant& plant, const Limits& limits) {
  const SaturatedDrive drive(stretch.request, plant, limits);
  const Profile& profile = stretch.profile;
  double square = profile.rate.front() * profile.rate.front(), late_s = 0;
  for (std::size_t k = 0; k + 1 < profile.s.size(); ++k) {
    const double ds = (profile.s[k + 1] - profile.s[k]) / kSteps;
    if (ds <= 0) continue;
    const double first = profile.rate[k] * profile.rate[k], last = profile.rate[k + 1] * profile.rate[k + 1];
    const auto planned = [&](int step) { return first + (last - first) * step / kSteps; };
    for (int step = 0; step < kSteps; ++step) {
      const double target = planned(step + 1), wanted = (target - square) / (2 * ds);
      const double a = drive.acceleration(profile.s[k] + step * ds, ds, square, wanted);
      const double next = std::clamp(square + 2 * ds * a, 0.0, std::max(target, square));
      if (square <= 0 && next <= 0) return kNoLimit;
      late_s += segment_s(ds, square, next) - segment_s(ds, planned(step), target);
      square = next;
    }
  }
  return std::max(0.0, late_s);
}

}  // namespace joulepath
