#include "scenarios/mission_files/plan_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/normal_quantiles.hpp"
#include "model/watt_hours.hpp"
#include "planner/accounts/plan_accounts.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: values that are not finite become null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json interval_95_J(double energy_J, const std::optional<double>& sigma_J) {
  if (!sigma_J) return nullptr;
  return {energy_J - kNormal95 * *sigma_J, energy_J + kNormal95 * *sigma_J};
}

Json cause_json(const EnergyByCause& energy) {
  // A sum that is zero by physics (kinetic energy from rest to rest) is written as zero, without rounding
  // noise.
  const double noise_J = 1e-9 * std::max(1.0, std::abs(energy.total_J()));
  const auto joules = [noise_J](double value_J) { return std::abs(value_J) < noise_J ? 0.0 : value_J; };
  Json effects = Json::object();
  for (const auto& [name, energy_J] : energy.effects_J) effects[name] = joules(energy_J);
  return {{"copper", joules(energy.copper_J)},
          {"coulomb_friction", joules(energy.coulomb_friction_J)},
          {"viscous_friction", joules(energy.viscous_friction_J)},
          {"kinetic", joules(energy.kinetic_J)},
          {"standby", joules(energy.standby_J)},
          {"effects", std::move(effects)},
          {"not_recovered", joules(energy.not_recovered_J)}};
}

/// A baseline and its difference to the least energy in its own time. `parameters` are the settings on the
/// longest stretch; `stretches` has them for every stretch.
Json baseline_json(const BaselineTotal& baseline, std::size_t longest) {
  Json json{{"name", baseline.name}, {"feasible", baseline.feasible}};
  if (!baseline.feasible) {
    json["reason"] = baseline.reason;
    return json;
  }
  json["energy_J"] = baseline.energy_J;
  json["motion_energy_J"] = baseline.motion_energy_J;
  json["duration_s"] = baseline.duration_s;
  if (baseline.late()) json["later_s"] = baseline.later_s;
  json["optimum_J"] = number(baseline.optimum_J);
  json["optimum_motion_J"] = number(baseline.optimum_motion_J);
  json["saving_percent"] = number(saving_percent(baseline.optimum_J, baseline.energy_J));
  json["motion_saving_percent"] = number(saving_percent(baseline.optimum_motion_J, baseline.motion_energy_J));
  if (longest < baseline.settings.size()) {
    json["parameters"] = baseline.settings[longest];
    json["stretches"] = baseline.settings;
  }
  return json;
}

Json payload_json(const PayloadAlongLeg& payload) {
  if (payload.from_kg == payload.to_kg) return payload.from_kg;
  return {{"from", payload.from_kg}, {"to", payload.to_kg}};
}

Json stretch_json(const StretchPlan& stretch) {
  const bool turn = is_turn(stretch.request.piece);
  const double length = piece_length(stretch.request.piece);
  return {{"kind", turn                                     ? "turn_in_place"
                   : travel_sign(stretch.request.piece) < 0 ? "curve_in_reverse"
                                                            : "curve"},
          {turn ? "angle_rad" : "length_m", turn ? turn_sign(stretch.request.piece) * length : length},
          {"duration_s", stretch.profile.duration_s()},
          {"energy_J", stretch.energy.total_J()},
          {"solver", stretch.summary.solver},
          {"iterations", stretch.summary.iterations},
          {"nodes", stretch.summary.nodes},
          {"lower_bound_J", number(stretch.summary.lower_bound_J)},
          {"lower_bound_s", number(stretch.summary.lower_bound_s)},
          {"optimality_gap_percent", number(stretch.summary.gap_percent)},
          {"local", stretch.summary.local},
          {"replay_energy_J", stretch.replay.energy_J},
          {"worst_violation", stretch.replay.worst_violation}};
}

Json alternative_json(const PathAlternative& alternative) {
  return {{"name", alternative.name},
          {"energy_J", number(alternative.energy_J)},
          {"duration_s", number(alternative.duration_s)},
          {"distance_m", alternative.distance_m},
          {"chosen", alternative.chosen}};
}

Json improvement_json(const WayImprovement& improvement) {
  return {{"step", improvement.step},
          {"energy_J", number(improvement.energy_J)},
          {"duration_s", number(improvement.duration_s)},
          {"cost_J", number(improvement.cost_J)}};
}

std::size_t longest_stretch(const LegPlan& leg) {
  std::size_t longest = 0;
  double most_s = -1.0;
  for (std::size_t k = 0; k < leg.stretches.size(); ++k)
    if (leg.stretches[k].profile.duration_s() > most_s) {
      most_s = leg.stretches[k].profile.duration_s();
      longest = k;
    }
  return longest;
}

/// The bound over all paths and the gap to it, where it was asked for.
void add_path_bound(const std::optional<PathBound>& bound, double energy_J, Json& json) {
  if (!bound) return;
  const bool known = bound->energy_J.has_value();
  json["path_lower_bound_J"] = known ? number(*bound->energy_J) : Json(nullptr);
  json["path_gap_percent"] = known ? number(path_gap_percent(*bound, energy_J)) : Json(nullptr);
  if (known)
    json["path_bound_part"] = path_bound_part_name(bound->part);
  else
    json["path_bound_reason"] = bound->reason;
}

Json leg_json(const LegPlan& leg) {
  Json json{{"to", leg.to},
            {"status", solve_status_name(leg.status)},
            {"energy_J", leg.energy.total_J()},
            {"energy_interval_95_J", interval_95_J(leg.energy.total_J(), leg.energy_sigma_J)},
            {"motion_energy_J", leg.energy.motion_J()},
            {"lower_bound_J", number(leg.lower_bound_J)},
            {"optimality_gap_percent", number(leg.gap_percent)},
            {"bound_without_jerk", limits_jerk(leg)},
            {"start_s", leg.start_s},
            {"duration_s", leg.duration_s},
            {"dwell_s", leg.dwell_s},
            {"distance_m", leg.distance_m},
            {"turned_rad", leg.turned_rad},
            {"payload_kg", payload_json(leg.payload)},
            {"price_of_time_W", leg.price_of_time_W},
            {"path", leg.path_source},
            {"energy_by_cause_J", cause_json(leg.energy)},
            {"stretches", Json::array()},
            {"alternatives", Json::array()},
            {"improvements", Json::array()},
            {"baselines", Json::array()}};
  add_path_bound(leg.path_bound, leg.energy.total_J(), json);
  if (leg.path_bound) json["far_above_path_bound"] = far_above_bound(leg);
  if (leg.charged_J > 0) json["charged_J"] = leg.charged_J;
  for (const StretchPlan& stretch : leg.stretches) json["stretches"].push_back(stretch_json(stretch));
  for (const PathAlternative& alternative : leg.alternatives)
    json["alternatives"].push_back(alternative_json(alternative));
  for (const WayImprovement& improvement : leg.improvements)
    json["improvements"].push_back(improvement_json(improvement));
  for (const BaselineTotal& baseline : leg.baselines)
    json["baselines"].push_back(baseline_json(baseline, longest_stretch(leg)));
  return json;
}

Json battery_json(const BatteryAccount& battery) {
  Json json{{"start_fraction", battery.start_fraction},
            {"end_fraction", battery.end_fraction},
            {"interval_95", battery.interval_95 ? Json(*battery.interval_95) : Json(nullptr)},
            {"charged_J", battery.charged_J},
            {"required_capacity_Wh", battery.required_capacity_Wh},
            {"missions_per_charge", number(battery.missions_per_charge)},
            {"lowest_voltage_V", number(battery.lowest_voltage_V)},
            {"fraction_after_leg", battery.fraction_after_leg}};
  if (battery.voltage_error_V) json["voltage_error_V"] = *battery.voltage_error_V;
  json["fails_on_leg"] = battery.fails_on_leg ? Json(*battery.fails_on_leg) : Json(nullptr);
  return json;
}

Json sided_json(const Sided<double>& value) { return {{"left", value.left}, {"right", value.right}}; }

Json sided_list_json(const std::vector<Sided<double>>& values) {
  Json list = Json::array();
  for (const Sided<double>& value : values) list.push_back(sided_json(value));
  return list;
}

/// How the legs were planned.
template <class Value>
Json list_of_states(const Plan& plan, Value&& value) {
  Json list = Json::array();
  for (const LegPlan& leg : plan.legs) list.push_back(value(leg.state));
  return list;
}

Json winding_json(const Plan& plan) {
  const WindingAccount& winding = *plan.winding;
  Json json{{"highest_C", winding.highest_C},
            {"side", side_name(winding.side)},
            {"above_limit_K", winding.above_limit_K},
            {"price_of_heat", winding.price_of_heat},
            {"highest_on_leg_C", sided_list_json(winding.hottest_on_leg_C)},
            {"after_leg_C", sided_list_json(winding.after_leg_C)},
            {"resistance_factor_on_leg", list_of_states(plan, [](const LegState& state) {
               return sided_json(state.resistance_factor);
             })}};
  if (winding.planned_current_A) json["planned_current_A"] = sided_json(*winding.planned_current_A);
  return json;
}

Json confidence_json(const Plan& plan) {
  const ConfidenceAccount& account = *plan.confidence;
  Json promises = Json::array();
  for (const Promise& promise : account.promises)
    promises.push_back({{"name", promise.name}, {"kept", promise.kept}, {"binds", promise.binds}});
  Json json{{"asked", account.asked},
            {"draws", account.draws},
            {"kept_without_margins", account.kept_without},
            {"energy_without_margins_J", account.energy_without_J},
            {"duration_without_margins_s", account.duration_without_s}};
  if (!is_driven(plan)) return json;
  json["kept"] = account.kept;
  json["kept_at_least"] = account.kept_at_least;
  json["promises"] = promises;
  json["limit_shares"] = account.limit_shares;
  json["reserve_margin_fraction"] = account.reserve_margin;
  return json;
}

Json infeasibility_json(const PlanInfeasibility& verdict) {
  return {{"constraint", verdict.reason.constraint},
          {"leg", verdict.leg},
          {"to", verdict.to},
          {"arc_length_m", verdict.arc_length_m},
          {"x_m", verdict.reason.x_m},
          {"y_m", verdict.reason.y_m},
          {"amount", number(verdict.reason.amount)},
          {"unit", verdict.reason.unit},
          {"relaxation", verdict.reason.relaxation},
          {"message", verdict.reason.message}};
}

void add_results(const Plan& plan, Json& json) {
  json["energy_J"] = plan.energy.total_J();
  json["motion_energy_J"] = plan.energy.motion_J();
  json["energy_Wh"] = plan.energy.total_J() / kJoulesPerWh;
  json["energy_sigma_J"] = plan.energy_sigma_J ? Json(*plan.energy_sigma_J) : Json(nullptr);
  json["uncertainty"] = uncertainty_text(plan);
  json["energy_interval_95_J"] = interval_95_J(plan.energy.total_J(), plan.energy_sigma_J);
  json["battery_loss_J"] = plan.battery ? plan.battery->loss_J : 0.0;
  json["duration_s"] = plan.duration_s;
  json["distance_m"] = plan.distance_m;
  json["lower_bound_J"] = number(plan.lower_bound_J);
  json["optimality_gap_percent"] = number(plan.gap_percent);
  json["bound_without_jerk"] = limits_jerk(plan);
  add_path_bound(plan.path_bound, plan.energy.total_J(), json);
  json["local"] = plan.local;
  json["energy_by_cause_J"] = cause_json(plan.energy);
  json["solver"] = {{"name", plan.solver}, {"iterations", plan.iterations}};
  json["replay"] = {{"energy_J", plan.replay_energy_J},
                    {"worst_violation", plan.worst_violation},
                    {"limit", plan.worst_limit}};
  if (plan.battery) json["battery"] = battery_json(*plan.battery);
  if (plan.battery && plan.battery->voltage_error_V)
    json["battery"]["open_circuit_voltage_on_leg_V"] =
        list_of_states(plan, [](const LegState& state) { return state.open_circuit_voltage_V; });
  if (plan.winding) json["winding"] = winding_json(plan);
  if (plan.visit)
    json["visit"] = {{"order", plan.visit->order},
                     {"exact", plan.visit->exact},
                     {"planned_orders", plan.visit->planned_orders},
                     {"estimated_energy_J", plan.visit->energy_J},
                     {"given_order_J", number(plan.visit->given_order_J.value_or(kNoLimit))},
                     {"lower_bound_J", plan.visit->lower_bound_J}};
  json["legs"] = Json::array();
  for (const LegPlan& leg : plan.legs) json["legs"].push_back(leg_json(leg));
  json["baselines"] = Json::array();
  for (const BaselineTotal& baseline : plan.baselines)
    json["baselines"].push_back(baseline_json(baseline, 0));
}

}  // namespace

const char* uncertainty_text(const Plan& plan) {
  if (!plan.energy_sigma_J)
    return "unknown: the robot file states none in uncertainty:; calibrate and diagnose measure it";
  return plan.sigma_has_model_error
             ? "of the robot file's constants and of the model"
             : "of the robot file's constants alone: it states no model_energy in uncertainty:";
}

const char* path_bound_part_name(PathBound::Part part) {
  if (part == PathBound::Part::corners) return "corners";
  return part == PathBound::Part::headings ? "headings" : "line";
}

std::string plan_json_text(const Plan& plan, const std::optional<PlanRobot>& robot) {
  Json json{
      {"schema", "joulepath/plan/1"}, {"mission", plan.mission}, {"status", solve_status_name(plan.status)}};
  if (robot) json["robot"] = {{"name", robot->name}, {"fingerprint", robot->fingerprint}};
  if (!plan.message.empty()) json["message"] = plan.message;
  if (plan.infeasibility || plan.status == SolveStatus::failed) json["legs"] = Json::array();
  if (plan.infeasibility)
    json["infeasibility"] = infeasibility_json(*plan.infeasibility);
  else if (plan.status != SolveStatus::failed)
    add_results(plan, json);
  if (plan.confidence) json["confidence"] = confidence_json(plan);
  return json.dump(1) + "\n";
}

std::string cause_json_text(const EnergyByCause& energy) { return cause_json(energy).dump(); }

}  // namespace joulepath
