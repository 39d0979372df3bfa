#include "app/plan/plan_summary.hpp"

#include <cmath>
#include <ostream>
#include <sstream>

#include "app/terminal.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/values/verdict_text.hpp"
#include "scenarios/mission_files/plan_file.hpp"

namespace joulepath {
namespace {

std::string kg(const PayloadAlongLeg& payload) {
  return payload.from_kg == payload.to_kg ? figure(payload.from_kg)
                                          : figure(payload.from_kg) + " to " + figure(payload.to_kg);
}

/// A sum that is zero by physics (kinetic energy from rest to rest) is shown as zero, without rounding noise.
double without_noise(double value, double whole) {
  return std::abs(value) < 1e-6 * std::abs(whole) ? 0.0 : value;
}

double effects_J(const EnergyByCause& energy) {
  double sum_J = 0.0;
  for (const auto& [name, energy_J] : energy.effects_J) sum_J += energy_J;
  return sum_J;
}

std::vector<std::string> energy_cells(const EnergyByCause& energy) {
  const auto joules = [&](double value_J) { return figure(without_noise(value_J, energy.total_J())); };
  return {joules(energy.copper_J),  joules(energy.coulomb_friction_J), joules(energy.viscous_friction_J),
          joules(energy.kinetic_J), joules(energy.not_recovered_J),    joules(effects_J(energy)),
          joules(energy.standby_J), figure(energy.total_J(), 5)};
}

void print_legs(std::ostream& stream, const Plan& plan) {
  Table table({"leg", "payload kg", "m", "s", "copper", "Coulomb", "viscous", "kinetic", "not recov.",
               "effects", "standby", "total J"});
  const auto row = [&](const std::string& name, const std::string& payload, double distance_m,
                       double duration_s, const EnergyByCause& energy) {
    std::vector<std::string> cells{name, payload, figure(distance_m), figure(duration_s)};
    for (std::string& cell : energy_cells(energy)) cells.push_back(std::move(cell));
    table.row(std::move(cells));
  };
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    const LegPlan& leg = plan.legs[k];
    row(std::to_string(k + 1) + " " + leg.to, kg(leg.payload), leg.distance_m, leg.duration_s + leg.dwell_s,
        leg.energy);
  }
  table.rule();
  row("all", "", plan.distance_m, plan.duration_s, plan.energy);
  table.print(stream);
}

void print_baselines(std::ostream& stream, const Plan& plan) {
  Table table(baseline_header());
  for (const BaselineTotal& baseline : plan.baselines) table.row(baseline_cells(baseline));
  table.row({"this plan", figure(plan.duration_s), figure(plan.energy.total_J(), 5), "", "",
             figure(plan.energy.motion_J(), 5), ""});
  table.print(stream);
  for (const BaselineTotal& baseline : plan.baselines) print_baseline_reason(stream, baseline);
}

/// A bound in some digits, rounded away from what it bounds.
std::string rounded(double value, int digits, double (*away)(double)) {
  if (!(std::abs(value) > 0) || !std::isfinite(value)) return figure(value, digits);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1);
  return figure(unit * away(value / unit), digits);
}
std::string at_least(double value, int digits) { return rounded(value, digits, std::floor); }
std::string at_most_percent(double value) { return rounded(value, 2, std::ceil) + " %"; }

/// Status and gap, with what the bound is about: the chosen paths, for a robot with a jerk limit without it.
std::string optimality_text(const Plan& plan) {
  return std::string(solve_status_name(plan.status)) + " on these paths" + (plan.local ? " (local)" : "") +
         ", gap to the bound " + (limits_jerk(plan) ? "without the jerk limit" : "there") +
         " <= " + at_most_percent(plan.gap_percent);
}

/// Gaps of the legs that have a bound; none where one leg is the mission.
std::string bounded_legs_text(const Plan& plan) {
  std::string text;
  for (std::size_t k = 0; plan.legs.size() > 1 && k < plan.legs.size(); ++k)
    if (const LegPlan& leg = plan.legs[k]; leg.path_bound && leg.path_bound->energy_J)
      text += (text.empty() ? "" : ", ") + leg_text(k, leg.to) +
              " <= " + at_most_percent(path_gap_percent(*leg.path_bound, leg.energy.total_J()));
  return text.empty() ? "" : "gaps of legs to any path: " + text + "\n";
}

/// The gap to any path, or why none is known.
void print_path_bound(std::ostream& stream, const Plan& plan) {
  if (!plan.path_bound) return;
  for (std::size_t k = 0; k < plan.legs.size(); ++k)
    if (const LegPlan& leg = plan.legs[k]; far_above_bound(leg))
      stream << "note: other paths of leg " << leg_text(k, leg.to) << " may save up to "
             << at_most_percent(path_gap_percent(*leg.path_bound, leg.energy.total_J()))
             << ": try another --seed or a stop on the way\n";
  stream << bounded_legs_text(plan);
  const PathBound& bound = *plan.path_bound;
  if (!bound.energy_J) {
    stream << "no bound over all paths: " << bound.reason << "\n";
    return;
  }
  stream << "no path of any kind takes less than " << at_least(*bound.energy_J, 5) << " J in this time"
         << (limits_jerk(plan) ? " without the jerk limit" : "")
         << ", gap <= " << at_most_percent(path_gap_percent(bound, plan.energy.total_J()))
         << " (weakest part of the bound: " << path_bound_part_name(bound.part) << ")\n";
}

void print_battery(std::ostream& stream, const BatteryAccount& battery, bool is_upper_bound) {
  stream << "battery " << figure(100 * battery.start_fraction, 4) << " % -> "
         << figure(100 * battery.end_fraction, 5) << " %";
  if (battery.interval_95)
    stream << " (95 %: " << figure(100 * (*battery.interval_95)[0], 5) << " to "
           << figure(100 * (*battery.interval_95)[1], 5) << ")";
  stream << ", needs " << figure(battery.required_capacity_Wh, 4) << " Wh"
         << (is_upper_bound ? " (95 % upper bound)" : " expected");
  if (std::isfinite(battery.missions_per_charge))
    stream << ", " << std::to_string(static_cast<long>(battery.missions_per_charge))
           << " such missions per charge";
  stream << '\n';
  if (battery.voltage_error_V)
    stream << "battery voltage at its least charge on each leg, at most "
           << figure(*battery.voltage_error_V, 2) << " V from the open-circuit curve\n";
}

void print_winding(std::ostream& stream, const WindingAccount& winding) {
  stream << "windings up to " << figure(winding.highest_C, 4) << " C (" << side_name(winding.side) << "), "
         << figure(-winding.above_limit_K, 3) << " K below the limit";
  if (winding.price_of_heat > 0)
    stream << ", slower for it: price of heat " << figure(winding.price_of_heat, 3);
  if (winding.planned_current_A)
    stream << ", slower for it: at most " << figure(winding.planned_current_A->left, 4) << " A left, "
           << figure(winding.planned_current_A->right, 4) << " A right";
  stream << "\n";
}

/// `arrival 0.97, reserve >0.999 (binds)`: lines are folded at blanks.
std::string promises_text(const ConfidenceAccount& account) {
  std::string text;
  for (const Promise& promise : account.promises)
    text += (text.empty() ? "" : ", ") + promise.name + " " +
            (promise.kept > 0.999 ? ">0.999" : figure(promise.kept, 3)) + (promise.binds ? " (binds)" : "");
  return text;
}

void print_confidence(std::ostream& stream, const Plan& plan) {
  const ConfidenceAccount& account = *plan.confidence;
  stream << figure(100 * account.kept, 4) << " % of " << std::to_string(account.draws)
         << " drawn robots keep all promises (asked " << figure(100 * account.asked, 4) << " %, shown "
         << figure(100 * account.kept_at_least, 4) << " %): " << promises_text(account) << "\n";
  if (account.limit_shares.empty() && account.reserve_margin == 0) return;
  stream << "  confidence changes the energy by "
         << figure(without_noise(plan.energy.total_J() - account.energy_without_J, plan.energy.total_J()), 3)
         << " J and the time by "
         << figure(without_noise(plan.duration_s - account.duration_without_s, plan.duration_s), 3)
         << " s; without margins\n  " << figure(100 * account.kept_without, 3)
         << " % of robots keep their promises\n";
}

/// Five significant digits, rounded to the feasible side: down for speeds at the ends, clearances and
/// resistances, up for limits and times. Positions keep all digits: a rounded one may be blocked.
std::string relaxed_figure(const std::string& key, double value) {
  if (key == "x_m" || key == "y_m" || value == 0) return figure(value, 10);
  const bool lower = key.rfind("start_speed", 0) == 0 || key.rfind("end_speed", 0) == 0 ||
                     key == "clearance_m" || key == "internal_resistance_ohm";
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 4);
  return figure(lower ? std::floor(value / step) * step : std::ceil(value / step) * step, 5);
}

void print_infeasibility(std::ostream& stream, const PlanInfeasibility& verdict) {
  const Infeasibility& reason = verdict.reason;
  stream << "infeasible: " << reason.constraint << " on leg " << leg_text(verdict.leg, verdict.to) << " at "
         << figure(verdict.arc_length_m) << " m (x " << figure(reason.x_m) << ", y " << figure(reason.y_m)
         << "), by " << figure(reason.amount) << " " << reason.unit << "\n";
  if (!reason.message.empty()) stream << "  " << reason.message << "\n";
  for (const auto& [key, value] : reason.relaxation)
    stream << "  smallest change that works: " << key << " = " << relaxed_figure(key, value) << "\n";
}

}  // namespace

std::vector<std::string> baseline_header() {
  return {"same path, own time", "s", "total J", "least J", "saved", "motion J", "saved of motion"};
}

std::vector<std::string> baseline_cells(const BaselineTotal& baseline) {
  if (!baseline.feasible) return {baseline.name, "-", "-", "-", "infeasible", "-", "infeasible"};
  const double saved = saving_percent(baseline.optimum_J, baseline.energy_J),
               saved_of_motion = saving_percent(baseline.optimum_motion_J, baseline.motion_energy_J);
  const auto percent = [](double value) { return std::isfinite(value) ? figure(value, 3) + " %" : "-"; };
  return {baseline.late() ? baseline.name + ", " + figure(baseline.later_s, 2) + " s later" : baseline.name,
          figure(baseline.duration_s),
          figure(baseline.energy_J, 5),
          figure(baseline.optimum_J, 5),
          percent(saved),
          figure(baseline.motion_energy_J, 5),
          percent(saved_of_motion)};
}

void print_baseline_reason(std::ostream& out, const BaselineTotal& baseline) {
  if (!baseline.feasible) out << baseline.name << ": " << baseline.reason << "\n";
}

void print_plan_summary(std::ostream& out, const Plan& plan, const std::string& directory) {
  std::ostringstream stream;
  if (plan.infeasibility) {
    print_infeasibility(stream, *plan.infeasibility);
  } else if (plan.status == SolveStatus::failed) {
    stream << "failed: " << plan.message << "\n";
  } else {
    print_legs(out, plan);
    out << "\n";
    print_baselines(out, plan);
    stream << "\n"
           << optimality_text(plan) << ", replay " << figure(plan.replay_energy_J, 6)
           << " J, worst violation " << figure(plan.worst_violation, 2) << "\n";
    print_path_bound(stream, plan);
    if (plan.battery) print_battery(stream, *plan.battery, plan.sigma_has_model_error);
    if (plan.winding) print_winding(stream, *plan.winding);
    if (plan.confidence) print_confidence(stream, plan);
    stream << "uncertainty " << uncertainty_text(plan) << "\n";
  }
  out << folded(stream.str(), 2) << "results in " << directory << "\n";
}

}  // namespace joulepath
