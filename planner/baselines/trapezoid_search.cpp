#include <cmath>

#include "planner/baselines/finish.hpp"
#include "planner/baselines/least_rate.hpp"
#include "planner/baselines/local_limits.hpp"
#include "planner/baselines/pattern_search.hpp"
#include "planner/baselines/rounded.hpp"
#include "planner/baselines/trapezoid.hpp"

namespace joulepath {
namespace {

/// Makes the executable profile take its time exactly; the nodes at the corners have changed it slightly.
BaselineResult finish_trapezoid(const ProfileRequest& request, const TrapezoidFamily& family,
                                const char* name, TrapezoidSettings settings, double duration_s) {
  const auto excess_s = [&](double rate) {
    TrapezoidSettings trial = settings;
    trial.rate = rate;
    return family.profile(trial).time_s.back() - duration_s;
  };
  const double low = settings.rate * (1 - 1e-2), high = settings.rate * (1 + 1e-2);
  if (excess_s(low) > 0 && excess_s(high) < 0) settings.rate = least_rate(excess_s, low, high);
  return finish_baseline(request, name, family.profile(settings), duration_s, family.parameters(settings));
}

BaselineResult no_trapezoid(const char* name, const TrapezoidFamily& family, double duration_s,
                            const char* otherwise) {
  constexpr double kNearly = 1e-3;
  const double least_s = family.least_duration_s();
  if (!(duration_s <= least_s * (1 + kNearly))) return no_baseline(name, otherwise);
  return no_baseline(name, "the plan's time is the least possible: no other profile meets it");
}

/// The settings of least energy for one share; nothing if none keeps the rows.
std::optional<TrapezoidSettings> tuned(const ProfileRequest& request, const TrapezoidFamily& family,
                                       double share, double duration_s) {
  const double most_up = most_acceleration(request), most_down = most_deceleration(request);
  constexpr double kRough = 1e-7;  // finish_trapezoid() makes the time exact
  const auto settings_at = [&](double up, double down) -> std::optional<TrapezoidSettings> {
    const double acceleration = most_up * std::exp(up), deceleration = most_down * std::exp(down);
    const auto rate = family.rate_for(acceleration, deceleration, share, duration_s, kRough);
    if (!rate) return std::nullopt;
    return TrapezoidSettings{*rate, acceleration, deceleration, share};
  };
  const PatternMinimum best = pattern_search([&](double up, double down) {
    const auto settings = settings_at(up, down);
    return settings ? family.energy_J(*family.squares(*settings)) : kNoLimit;
  });
  return std::isfinite(best.value) ? settings_at(best.x, best.y) : std::nullopt;
}

/// The trapezoid for one share, with the settings that `settings_of` chooses, shaped by the limits of
/// `inner`.
template <class SettingsOf>
BaselineResult of_share(const ProfileRequest& request, const ProfileRequest& inner, const char* name,
                        double duration_s, const char* otherwise, SettingsOf&& settings_of) {
  const TrapezoidFamily family(inner);
  const std::optional<TrapezoidSettings> settings = settings_of(family);
  if (!settings) return no_trapezoid(name, family, duration_s, otherwise);
  return finish_trapezoid(request, family, name, *settings, duration_s);
}

}  // namespace

BaselineResult trapezoid_max_acceleration(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_max_acceleration";
  if (is_rounded(request)) return rounded_max_acceleration(request, kName, duration_s);
  const auto make = [&](const ProfileRequest& inner, double share) {
    const double up = most_acceleration(inner), down = most_deceleration(inner);
    return of_share(request, inner, kName, duration_s, "cannot meet the time with the local speed limits",
                    [&](const TrapezoidFamily& family) {
                      const auto rate = family.rate_for(up, down, share, duration_s);
                      return rate ? std::optional(TrapezoidSettings{*rate, up, down, share}) : std::nullopt;
                    });
  };
  return best_share(request, LocalLimits(request).shares(), make);
}

BaselineResult trapezoid_best_tuned(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "trapezoid_best_tuned";
  if (is_rounded(request)) return rounded_best_tuned(request, kName, duration_s);
  const auto make = [&](const ProfileRequest& inner, double share) {
    return of_share(request, inner, kName, duration_s, "no trapezoid meets the time within the limits",
                    [&](const TrapezoidFamily& family) { return tuned(inner, family, share, duration_s); });
  };
  BaselineResult best = best_share(request, LocalLimits(request).shares(), make);
  // The largest accelerations are candidates as well, checked on the exact path like all others.
  BaselineResult largest = trapezoid_max_acceleration(request, duration_s);
  largest.name = kName;
  return largest.profile && (!best.profile || better(largest, best)) ? largest : best;
}

}  // namespace joulepath
