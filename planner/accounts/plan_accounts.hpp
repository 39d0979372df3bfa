#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

/// Adds the two trapezoids to the stretches of a plan, in their times, and the totals to its legs and to it.
void add_baselines(Plan& plan, double standby_W, unsigned threads);

/// Totals over the legs: energy by cause, time, gap, replay, status.
void sum_up(Plan& plan, const Plant& plant, double accuracy);

/// Whether a curve of a leg has a jerk limit. The choice of ways, drafts and bounds leave it out
/// (jerk_profile.cpp), so that a gap holds the price of the jerk limit, too.
[[nodiscard]] bool limits_jerk(const LegPlan& leg);
[[nodiscard]] bool limits_jerk(const Plan& plan);

/// The verdicts on times that are too short.
[[nodiscard]] Infeasibility late_arrival(const MissionRequest& mission, std::size_t leg, double amount_s,
                                         double s_m, const Pose& pose);
[[nodiscard]] Infeasibility too_short(double duration_s, double minimum_s, double s_m, const Pose& pose);

/// How far (%) a plan of an energy lies above the bound over all paths at most, relative to its energy.
[[nodiscard]] double path_gap_percent(const PathBound& bound, double energy_J);

/// Whether a leg lies so far above its bound, with no corner to explain it, that a better path is likely.
[[nodiscard]] bool far_above_bound(const LegPlan& leg);

/// Saving (%) of `energy_J` against a baseline's; 0 if the baseline takes no energy.
[[nodiscard]] double saving_percent(double energy_J, double baseline_J);

}  // namespace joulepath
