#include "planner/controller/leg_settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/pattern_search.hpp"
#include "planner/baselines/rounded.hpp"

namespace joulepath {
namespace {

constexpr std::array<double, 3> kSettingShares{1.0, 0.75, 0.5};

/// Stretches of one kind that share their settings.
class Group {
 public:
  /// Adds the stretches of a leg; the upper bounds of the settings are the least of theirs.
  void add(const LegPlan& leg, bool turns) {
    for (const StretchPlan& stretch : leg.stretches) {
      if (is_turn(stretch.request.piece) != turns) continue;
      families_.emplace_back(stretch.request);
      requests_.push_back(&stretch.request);
      duration_s_ += stretch.profile.time_s.back();
      const TrapezoidSettings own = fastest_settings({}, stretch, families_.back());
      fastest_.rate = std::min(fastest_.rate, own.rate);
      fastest_.acceleration = std::min(fastest_.acceleration, own.acceleration);
      fastest_.deceleration = std::min(fastest_.deceleration, own.deceleration);
    }
  }

  bool empty() const { return families_.empty(); }
  const TrapezoidSettings& fastest() const { return fastest_; }

  /// How much later than the plan a drive with these settings ends because a jerk limit rounds its corners.
  double late_s(const TrapezoidSettings& settings) const {
    if (std::none_of(requests_.begin(), requests_.end(), [](const auto* r) { return is_rounded(*r); }))
      return 0;
    double sum_s = 0;
    for (const ProfileRequest* request : requests_) {
      const std::optional<Profile> profile = fastest_profile(*request, settings);
      sum_s += profile ? profile->time_s.back() : kNoLimit;
    }
    return sum_s - duration_s_;
  }

  /// Tunes for a time that is shorter than the plan's.
  void hurry(double by_s) { hurried_s_ += by_s; }

  /// The settings of least energy that take the plan's time.
  std::optional<TrapezoidSettings> tuned() const {
    const bool curves = std::any_of(families_.begin(), families_.end(),
                                    [](const TrapezoidFamily& family) { return family.curves(); });
    std::optional<TrapezoidSettings> best;
    double least_J = kNoLimit;
    for (const double share : kSettingShares) {
      const PatternMinimum found =
          pattern_search([&](double up, double down) { return energy_J(settings_at(up, down, share)); });
      if (found.value < least_J) {
        least_J = found.value;
        best = settings_at(found.x, found.y, share);
      }
      if (!curves) break;
    }
    return best;
  }

 private:
  double duration_s(const TrapezoidSettings& settings) const {
    double sum_s = 0;
    for (const TrapezoidFamily& family : families_) {
      const auto squares = family.squares(settings);
      sum_s += squares ? family.duration_s(*squares) : kNoLimit;
    }
    return sum_s;
  }

  std::optional<TrapezoidSettings> settings_at(double up, double down, double share) const {
    TrapezoidSettings settings{fastest_.rate, fastest_.acceleration * std::exp(up),
                               fastest_.deceleration * std::exp(down), share};
    const double aim_s = duration_s_ - hurried_s_;
    if (duration_s(settings) > aim_s) return std::nullopt;
    double low = 0, high = fastest_.rate;
    for (int i = 0; i < 40; ++i) {
      settings.rate = 0.5 * (low + high);
      (duration_s(settings) > aim_s ? low : high) = settings.rate;
    }
    settings.rate = high;
    return settings;
  }

  double energy_J(const std::optional<TrapezoidSettings>& settings) const {
    if (!settings) return kNoLimit;
    double sum_J = 0;
    for (const TrapezoidFamily& family : families_) sum_J += family.energy_J(*family.squares(*settings));
    return sum_J;
  }

  std::vector<TrapezoidFamily> families_{};
  std::vector<const ProfileRequest*> requests_{};
  double duration_s_{}, hurried_s_{};
  TrapezoidSettings fastest_{kNoLimit, kNoLimit, kNoLimit};
};

/// Rounded up to three decimals, but not above the robot's limits.
double rounded_up(double value, double most) { return std::min(most, std::ceil(1000 * value - 1e-6) / 1000); }

TrapezoidSettings rounded_settings(TrapezoidSettings settings, const TrapezoidSettings& fastest) {
  settings.rate = rounded_up(settings.rate, fastest.rate);
  settings.acceleration = rounded_up(settings.acceleration, fastest.acceleration);
  settings.deceleration = rounded_up(settings.deceleration, fastest.deceleration);
  return settings;
}

std::optional<TrapezoidSettings> settings_of(Group group) {
  constexpr int kTries = 6;
  constexpr double kFurther = 1.05;
  if (group.empty()) return std::nullopt;
  const TrapezoidSettings& fastest = group.fastest();
  for (int i = 0; i < kTries; ++i) {
    const std::optional<TrapezoidSettings> tuned = group.tuned();
    if (!tuned) break;
    const TrapezoidSettings settings = rounded_settings(*tuned, fastest);
    const double late_s = group.late_s(settings);
    if (late_s <= 0) return settings;
    group.hurry(kFurther * late_s);
  }
  return rounded_settings(fastest, fastest);
}

}  // namespace

std::vector<LegSettings> leg_settings(const Plan& plan) {
  std::vector<LegSettings> settings;
  for (const LegPlan& leg : plan.legs) {
    Group drives, turns;
    drives.add(leg, false);
    turns.add(leg, true);
    settings.push_back({.drive = settings_of(drives), .turn = settings_of(turns)});
  }
  return settings;
}

LegSettings mission_settings(const Plan& plan) {
  Group drives, turns;
  for (const LegPlan& leg : plan.legs) {
    drives.add(leg, false);
    turns.add(leg, true);
  }
  return {.drive = settings_of(drives), .turn = settings_of(turns)};
}

ControlledDrive drive_with(const Plan& plan, const std::vector<LegSettings>& settings) {
  return drive_by_controller(
      plan, [&](const StretchPlace& place, const StretchPlan& stretch, const TrapezoidFamily&) {
        const LegSettings& leg = settings[place.leg];
        return is_turn(stretch.request.piece) ? *leg.turn : *leg.drive;
      });
}

}  // namespace joulepath
