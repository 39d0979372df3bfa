#include "extensions/nav2/leg_settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/least_rate.hpp"
#include "planner/baselines/pattern_search.hpp"
#include "planner/baselines/rounded.hpp"
#include "planner/motion/path_motion.hpp"

// Design: docs/decisions/0401-controllers-and-graphs.md
namespace joulepath {
namespace {

constexpr std::array<double, 3> kSettingShares{1.0, 0.75, 0.5};
constexpr double kOnTime = 1e-6;         ///< relative
constexpr std::size_t kDraftNodes = 60;  ///< for comparisons of accelerations

/// Rounded up to millionths, so that the controller is not late, but not above the robot's limits.
double rounded_up(double value, double most) { return std::min(most, std::ceil(1e6 * value - 1e-3) / 1e6); }

/// Stretches of one kind that share their settings.
class Group {
 public:
  /// `one_acceleration`: for both directions of speed changes.
  explicit Group(bool one_acceleration = false) : one_acceleration_(one_acceleration) {}

  /// Adds the stretches of a leg; the upper bounds of the settings are the least of theirs. A limit of
  /// driving in reverse bounds the rate of those stretches alone, unless nothing is driven forward.
  void add(const LegPlan& leg, bool turns) {
    for (const StretchPlan& stretch : leg.stretches) {
      if (is_turn(stretch.request.piece) != turns) continue;
      families_.emplace_back(stretch.request);
      requests_.push_back(stretch.request);
      drafts_.push_back(stretch.request);
      drafts_.back().nodes = std::min(drafts_.back().nodes, kDraftNodes);
      duration_s_ += stretch.profile.time_s.back();
      length_ += path_motion(stretch.request).length();
      const TrapezoidSettings own = fastest_settings({}, stretch);
      const bool forward = turns || travel_sign(stretch.request.piece) > 0;
      if (forward && !has_forward_) fastest_.rate = own.rate;
      has_forward_ |= forward;
      if (forward == has_forward_) fastest_.rate = std::min(fastest_.rate, own.rate);
      fastest_.acceleration = std::min(fastest_.acceleration, own.acceleration);
      fastest_.deceleration = std::min(fastest_.deceleration, own.deceleration);
    }
  }

  /// The settings of least energy with which the controller takes the plan's time.
  std::optional<TrapezoidSettings> settings() const {
    if (families_.empty()) return std::nullopt;
    Driven best = in_time(drafts_, sharp_settings(0, 0, 1));
    const bool curves = std::any_of(families_.begin(), families_.end(),
                                    [](const TrapezoidFamily& family) { return family.curves(); });
    for (const double share : kSettingShares) {
      const Driven found = near_sharp(share);
      if (found.energy_J < best.energy_J) best = found;
      if (!curves) break;
    }
    best.settings.rate = fastest_.rate;
    const Driven found = in_time(requests_, best.settings);
    return std::isfinite(found.energy_J) ? found.settings
                                         : in_time(requests_, sharp_settings(0, 0, 1)).settings;
  }

 private:
  /// Settings and what the controller's drive with them takes.
  struct Driven {
    TrapezoidSettings settings{};
    double duration_s{}, energy_J{};  ///< energy at the plan's arrival, standby until then included
  };

  using Requests = std::vector<ProfileRequest>;

  Driven driven(const Requests& requests, const TrapezoidSettings& settings) const {
    Driven sum{.settings = settings};
    for (const ProfileRequest& request : requests) {
      TrapezoidSettings own = settings;
      if (!is_turn(request.piece)) own.rate = std::min(own.rate, request.limits.speed_m_s);
      const BaselineResult result = controlled_stretch(request, own);
      sum.duration_s += result.profile ? result.duration_s : kNoLimit;
      sum.energy_J += result.feasible ? result.energy_J : kNoLimit;
    }
    sum.energy_J += requests.front().plant.robot.power.standby_W * (duration_s_ - sum.duration_s);
    return sum;
  }

  /// The lowest cruise rate up to that of `settings` that is not late; infinite energy where every rate is.
  Driven in_time(const Requests& requests, TrapezoidSettings settings) const {
    constexpr double kRates = 1e-6;
    settings.acceleration = rounded_up(settings.acceleration, fastest_.acceleration);
    settings.deceleration = rounded_up(settings.deceleration, fastest_.deceleration);
    const double latest_s = duration_s_ * (1 + kOnTime), most = settings.rate, slow = length_ / latest_s;
    const auto late_s = [&](double rate) {
      settings.rate = rate;
      return driven(requests, settings).duration_s - latest_s;
    };
    if (late_s(most) > 0) return {.settings = settings, .energy_J = kNoLimit};
    if (late_s(slow) > 0) settings.rate = least_rate(late_s, slow, most, kRates);
    settings.rate = rounded_up(settings.rate, fastest_.rate);
    return driven(requests, settings);
  }

  /// The best trapezoids with sharp corners, driven; where rounding makes them late, on the way from them to
  /// the largest accelerations.
  Driven near_sharp(double share) const {
    const PatternMinimum sharp =
        pattern_search([&](double up, double down) { return sharp_energy_J(up, down, share); });
    Driven found{.energy_J = kNoLimit};
    if (!std::isfinite(sharp.value)) return found;
    for (const double part : {1.0, 0.75, 0.5, 0.25}) {
      found = in_time(drafts_, sharp_settings(part * sharp.x, part * sharp.y, 1));
      if (std::isfinite(found.energy_J)) break;
    }
    return found;
  }

  TrapezoidSettings sharp_settings(double up, double down, double share) const {
    if (one_acceleration_) down = up;
    return {fastest_.rate, fastest_.acceleration * std::exp(up), fastest_.deceleration * std::exp(down),
            share};
  }

  double sharp_duration_s(const TrapezoidSettings& settings) const {
    double sum_s = 0;
    for (const TrapezoidFamily& family : families_) {
      const auto squares = family.squares(settings);
      sum_s += squares ? family.duration_s(*squares) : kNoLimit;
    }
    return sum_s;
  }

  /// Energy of trapezoids with sharp corners in the plan's time, for the search only. A jerk limit takes
  /// (acceleration + deceleration)/(2 jerk) of the time of each stretch.
  double sharp_energy_J(double up, double down, double share) const {
    TrapezoidSettings settings = sharp_settings(up, down, share);
    double aim_s = duration_s_;
    for (const ProfileRequest& request : requests_)
      if (is_rounded(request))
        aim_s -= (settings.acceleration + settings.deceleration) / (2 * request.limits.jerk_m_s3);
    if (sharp_duration_s(settings) > aim_s) return kNoLimit;
    double low = 0, high = fastest_.rate;
    for (int i = 0; i < 40; ++i) {
      settings.rate = 0.5 * (low + high);
      (sharp_duration_s(settings) > aim_s ? low : high) = settings.rate;
    }
    settings.rate = high;
    double sum_J = 0;
    for (const TrapezoidFamily& family : families_) sum_J += family.energy_J(*family.squares(settings));
    return sum_J;
  }

  bool has_forward_{};
  bool one_acceleration_{};
  std::vector<TrapezoidFamily> families_{};
  Requests requests_{}, drafts_{};
  double duration_s_{}, length_{};
  TrapezoidSettings fastest_{kNoLimit, kNoLimit, kNoLimit};
};

}  // namespace

std::vector<LegSettings> leg_settings(const Plan& plan) {
  std::vector<LegSettings> settings;
  for (const LegPlan& leg : plan.legs) {
    Group drives, turns;
    drives.add(leg, false);
    turns.add(leg, true);
    settings.push_back({.drive = drives.settings(), .turn = turns.settings()});
  }
  return settings;
}

LegSettings mission_settings(const Plan& plan) {
  Group drives, turns(true);
  for (const LegPlan& leg : plan.legs) {
    drives.add(leg, false);
    turns.add(leg, true);
  }
  return {.drive = drives.settings(), .turn = turns.settings()};
}

ControlledDrive drive_with(const Plan& plan, const std::vector<LegSettings>& settings) {
  constexpr TrapezoidSettings kFree{TrapezoidFamily::kUnlimited, TrapezoidFamily::kUnlimited,
                                    TrapezoidFamily::kUnlimited};
  Plan limited = plan;
  for (std::size_t leg = 0; leg < plan.legs.size(); ++leg)
    for (StretchPlan& stretch : limited.legs[leg].stretches) {
      if (is_turn(stretch.request.piece)) continue;
      Limits& limits = stretch.request.limits;
      limits.yaw_rate_rad_s = std::min(limits.yaw_rate_rad_s, settings[leg].yaw_rate_rad_s);
      limits.yaw_acceleration_rad_s2 =
          std::min(limits.yaw_acceleration_rad_s2, settings[leg].yaw_acceleration_rad_s2);
    }
  return drive_by_controller(limited, [&](const StretchPlace& place, const StretchPlan& stretch) {
    const LegSettings& leg = settings[place.leg];
    return (is_turn(stretch.request.piece) ? leg.turn : leg.drive).value_or(kFree);
  });
}

}  // namespace joulepath
