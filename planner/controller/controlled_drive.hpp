#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/baselines/trapezoid.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plan's stretch and its place.
struct StretchPlace {
  std::size_t leg{};
  std::size_t stretch{};  ///< within the leg
  double from_m{};        ///< arc length of the leg where it begins
};

/// Calls visit(place, stretch) for each stretch of a plan, in order.
void for_each_stretch(const Plan& plan,
                      const std::function<void(const StretchPlace&, const StretchPlan&)>& visit);

/// A plan's path driven by a controller without a speed profile, as fast as its settings and the local limits
/// allow: trapezoids from stop to stop, rounded where the robot has a jerk limit. Prescribed motions and
/// dwells are as in the plan.
struct ControlledDrive {
  double energy_J{};         ///< at the battery's terminals, standby included
  double motion_energy_J{};  ///< without standby
  double duration_s{};
  std::vector<double> stretch_s{};  ///< driving time of each stretch
  std::vector<Profile> profiles{};  ///< of each stretch; without nodes where there is none
  std::string broken_limit{};       ///< the first exceeded limit, with its place; empty: none
};

/// The settings for one stretch. The robot's limits hold too.
using StretchSettings = std::function<TrapezoidSettings(const StretchPlace&, const StretchPlan&)>;
/// Speed caps on one stretch, besides the mission's own.
using StretchCaps = std::function<std::vector<SpeedCap>(const StretchPlace&, const StretchPlan&)>;

/// One stretch, as fast as the settings and all limits allow.
[[nodiscard]] BaselineResult controlled_stretch(const ProfileRequest& request,
                                                const TrapezoidSettings& settings);

/// Drives a valid plan's stretches. Energy by the same model on the exact path.
[[nodiscard]] ControlledDrive drive_by_controller(const Plan& plan, const StretchSettings& settings,
                                                  const StretchCaps& caps = {});

/// As fast as the robot's own limits allow.
[[nodiscard]] TrapezoidSettings fastest_settings(const StretchPlace& place, const StretchPlan& stretch);

/// Energy of a controller's drive, and the least energy along its path in the same time.
struct LossAtTime {
  double duration_s{};
  double energy_J{};
  double optimum_J{};
  [[nodiscard]] double lost_J() const { return energy_J - optimum_J; }
  [[nodiscard]] double lost_percent() const { return energy_J > 0 ? 100 * lost_J() / energy_J : 0.0; }
};

/// The loss of a controller that cannot follow the plan's speeds.
struct ControllerLoss {
  /// In the controller's own time; the optimum is the sum over the stretches, each in the controller's time.
  LossAtTime own_time{};
  /// At the plan's time, if the controller is not later: it waits at the end, standby included.
  std::optional<LossAtTime> plan_time{};
  std::string broken_limit{};
};

[[nodiscard]] ControllerLoss loss_of(const Plan& plan, const ControlledDrive& drive);

}  // namespace joulepath
