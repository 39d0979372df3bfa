#include "planner/confidence/lateness.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/limit_check.hpp"

namespace joulepath {
namespace {

constexpr double kSaturated = 1 + 1e-6;  ///< use of a limit
constexpr int kHalvings = 20;

/// One stretch, driven by another plant.
class SaturatedDrive {
 public:
  SaturatedDrive(const ProfileRequest& request, const Plant& plant, const Limits& limits)
      : motion_(request.piece, plant, request.payload, request.time_of_day_s, request.memory),
        limits_(limits) {}

  /// The greatest acceleration, at most the wanted one, from a squared rate over a distance of s.
  double acceleration(double s, double ds, double square, double wanted) const {
    if (wanted < 0 || holds(s, ds, square, wanted)) return wanted;
    double low = -0.5 * square / ds, high = wanted;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(s, ds, square, middle) ? low : high) = middle;
    }
    return low;
  }

 private:
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
    const double ds = profile.s[k + 1] - profile.s[k];
    if (ds <= 0) continue;
    const double before = profile.rate[k] * profile.rate[k],
                 target = profile.rate[k + 1] * profile.rate[k + 1];
    const double wanted = (target - square) / (2 * ds);
    const double next = std::min(std::max(target, square),
                                 square + 2 * ds * drive.acceleration(profile.s[k], ds, square, wanted));
    if (square <= 0 && next <= 0) return kNoLimit;
    late_s += segment_s(ds, square, std::max(0.0, next)) - segment_s(ds, before, target);
    square = std::max(0.0, next);
  }
  return std::max(0.0, late_s);
}

}  // namespace joulepath
