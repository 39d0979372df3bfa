#include "planner/baselines/rounded.hpp"

#include <algorithm>
#include <cmath>

#include "planner/baselines/finish.hpp"
#include "planner/baselines/local_limits.hpp"
#include "planner/baselines/pattern_search.hpp"
#include "planner/baselines/shapes.hpp"
#include "planner/baselines/trapezoid.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
// Design: docs/decisions/0302-jerk.md

namespace joulepath {
namespace {

constexpr double kRoom = 1e-7;  ///< relative, of the jerk limit

/// A profile's acceleration at a time, 0 outside of it; calls must be in the order of time.
class AccelerationInOrder {
 public:
  explicit AccelerationInOrder(const Profile& profile) : profile_(profile) {}
  double operator()(double time_s) {
    if (time_s <= 0 || time_s >= profile_.time_s.back()) return 0.0;
    while (profile_.time_s[k_ + 1] <= time_s) ++k_;
    return profile_.acceleration[k_];
  }

 private:
  const Profile& profile_;
  std::size_t k_{};
};

/// A motion from rest to rest whose rate is averaged over a window of time: a jump of its acceleration
/// becomes a ramp over the window, and its duration grows by the window. A trapezoid becomes an S-curve.
Profile averaged(const Profile& profile, double window_s) {
  std::vector<double> times = profile.time_s;
  for (double time_s : profile.time_s) times.push_back(time_s + window_s);
  std::sort(times.begin(), times.end());
  AccelerationInOrder front(profile), tail(profile);
  std::vector<JerkPiece> pieces;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double middle_s = 0.5 * (times[k] + times[k + 1]);
    pieces.push_back({times[k + 1] - times[k], (front(middle_s) - tail(middle_s - window_s)) / window_s});
  }
  Profile round = jerk_profile(pieces);
  round.s.back() = profile.s.back();
  round.rate.back() = 0;
  return round;
}

double worst_jerk(const Profile& profile) {
  double worst = 0;
  for (double jerk : profile.jerk) worst = std::max(worst, std::abs(jerk));
  return worst;
}

/// Rounded trapezoids over one request, with one share of the yaw acceleration.
class RoundedTrapezoids {
 public:
  RoundedTrapezoids(const ProfileRequest& request, double share)
      : request_(request),
        motion_(path_motion(request)),
        jerk_(request.limits.jerk_m_s3 * (1 - kRoom)),
        local_(request),
        grid_(local_.grid(share)) {}

  /// The member that takes `duration_s`; nothing if none is so fast.
  std::optional<Profile> profile(double up, double down, double duration_s) const {
    constexpr int kTries = 4;
    double window_s = std::max(up, down) / jerk_;
    for (int i = 0; i < kTries; ++i) {
      const std::optional<Profile> sharp = trapezoid(up, down, window_s, duration_s - window_s);
      if (!sharp) return std::nullopt;
      Profile round = averaged(*sharp, window_s);
      const double ratio = worst_jerk(round) / jerk_;
      if (ratio <= 1) return round;
      window_s = std::min(window_s * ratio * (1 + kRoom), (up + down) / jerk_);
    }
    return std::nullopt;
  }

  /// Energy (J) without standby by one node per segment, for comparisons of members.
  double energy_J(const Profile& profile) const {
    double sum_J = 0;
    for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k) {
      const double dt = profile.time_s[k + 1] - profile.time_s[k];
      sum_J += dt * drive_power_W(motion_, profile.at_time(profile.time_s[k] + dt / 2));
    }
    return sum_J;
  }

 private:
  std::optional<Profile> trapezoid(double up, double down, double window_s, double duration_s) const {
    const LocalLimits::Grid grid = lowered(up, down, window_s);
    const auto made = [&](double rate) {
      LocalLimits::Grid fine = grid;
      const double square = rate * rate, length = grid.s.back();
      for (double corner : {square / (2 * up), length - square / (2 * down), down * length / (up + down)})
        fine.insert(corner);
      std::vector<double> b = local_.below(fine, std::vector<double>(fine.s.size(), square), up, down);
      return std::pair(local_.passes(b), profile_from_squares(fine.s, b));
    };
    double low = 0, high = std::sqrt(*std::max_element(grid.cap.begin(), grid.cap.end()));
    if (duration_s <= 0) return std::nullopt;
    if (const auto [passes, fastest] = made(high); !passes || fastest.duration_s() > duration_s)
      return std::nullopt;
    constexpr int kHalvings = 32;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (made(middle).second.duration_s() > duration_s ? low : high) = middle;
    }
    return made(high).second;
  }

  /// The grid with the least cap of the places that the fastest drive passes within half a window of each
  /// node.
  LocalLimits::Grid lowered(double up, double down, double window_s) const {
    const std::vector<double> b = local_.below(grid_, grid_.cap, up, down);
    const Profile fastest = profile_from_squares(grid_.s, b);
    const std::vector<double>& time_s = fastest.time_s;
    LocalLimits::Grid lowered = grid_;
    for (std::size_t k = 0; k < time_s.size(); ++k) {
      const auto from = std::lower_bound(time_s.begin(), time_s.end(), time_s[k] - window_s / 2);
      const auto to = std::upper_bound(time_s.begin(), time_s.end(), time_s[k] + window_s / 2);
      const auto first = std::max<std::ptrdiff_t>(0, from - time_s.begin() - 1);
      const auto last = std::min<std::ptrdiff_t>(to - time_s.begin() + 1, std::ssize(time_s));
      lowered.cap[k] = *std::min_element(grid_.cap.begin() + first, grid_.cap.begin() + last);
    }
    return lowered;
  }

  const ProfileRequest& request_;
  PathMotion motion_;
  double jerk_;
  LocalLimits local_;
  LocalLimits::Grid grid_;
};

using Choice = std::function<std::optional<Profile>(const ProfileRequest& inner, const RoundedTrapezoids&)>;

BaselineResult best_rounded(const ProfileRequest& request, const char* name, double duration_s,
                            const Choice& choice) {
  if (request.start_rate != 0 || request.end_rate != 0)
    return no_baseline(name, "under a jerk limit defined from rest to rest only");
  const auto make = [&](const ProfileRequest& inner, double share) {
    std::optional<Profile> profile = choice(inner, RoundedTrapezoids(inner, share));
    if (!profile) return no_baseline(name, "cannot meet the time within the jerk limit");
    return finish_baseline(request, name, std::move(*profile), duration_s,
                           {{"jerk_m_s3", request.limits.jerk_m_s3}});
  };
  return best_share(request, LocalLimits(request).shares(), make);
}

}  // namespace

bool is_rounded(const ProfileRequest& request) {
  return std::isfinite(request.limits.jerk_m_s3) && request.limits.jerk_m_s3 > 0 && !is_turn(request.piece);
}

BaselineResult rounded_max_acceleration(const ProfileRequest& request, const char* name, double duration_s) {
  return best_rounded(request, name, duration_s,
                      [&](const ProfileRequest& inner, const RoundedTrapezoids& family) {
                        return family.profile(most_acceleration(inner), most_deceleration(inner), duration_s);
                      });
}

BaselineResult rounded_best_tuned(const ProfileRequest& request, const char* name, double duration_s) {
  BaselineResult largest = rounded_max_acceleration(request, name, duration_s);
  if (!largest.profile) return largest;
  // The accelerations are tuned with the share that leaves the most room in curves; then every share is
  // tried.
  const RoundedTrapezoids widest(request, 1.0);
  const auto member = [&](const ProfileRequest& inner, const RoundedTrapezoids& family, double up,
                          double down) {
    return family.profile(most_acceleration(inner) * std::exp(up), most_deceleration(inner) * std::exp(down),
                          duration_s);
  };
  const PatternMinimum least = pattern_search([&](double up, double down) {
    const std::optional<Profile> profile = member(request, widest, up, down);
    return profile ? widest.energy_J(*profile) : kNoLimit;
  });
  if (!std::isfinite(least.value)) return largest;
  BaselineResult tuned = best_rounded(request, name, duration_s,
                                      [&](const ProfileRequest& inner, const RoundedTrapezoids& family) {
                                        return member(inner, family, least.x, least.y);
                                      });
  return tuned.profile && better(tuned, largest) ? tuned : largest;
}

}  // namespace joulepath
