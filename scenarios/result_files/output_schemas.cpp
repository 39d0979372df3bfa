#include "scenarios/result_files/output_schemas.hpp"

#include "diagnosis/values/verdict.hpp"

namespace joulepath {
namespace {

Schema result() { return nullable(number()); }  ///< null if it is not finite
Schema interval() { return list(result(), 2, 2); }
Schema plan_status() { return choice({"optimal", "feasible", "infeasible", "failed"}); }

std::vector<std::string> verdict_names() {
  std::vector<std::string> names;
  for (const VerdictWords& words : kVerdicts) names.emplace_back(words.name);
  return names;
}

Schema causes_schema() {
  return open(
      map({required("copper", number()), required("coulomb_friction", number()),
           required("viscous_friction", number()), required("kinetic", number()),
           required("standby", number()), required("effects", dictionary(number()), "joules by effect"),
           required("not_recovered", number(), "braking power that the drives cannot return")}));
}

Schema baselines_schema() {
  return list(
      open(map({required("name", text()), optional("feasible", boolean()), optional("energy_J", result()),
                optional("motion_energy_J", result()), optional("duration_s", result()),
                optional("later_s", result(), "delay beyond the plan's time, which no such profile meets"),
                optional("optimum_J", result(), "least energy on this path in this profile's time"),
                optional("optimum_motion_J", result(), "without standby"),
                optional("saving_percent", result(), "of the optimum in the same time"),
                optional("motion_saving_percent", result()), optional("parameters", dictionary(result()))})));
}

Schema alternatives_schema() {
  return list(
      open(map({required("name", text()), required("energy_J", result()), required("duration_s", result()),
                required("distance_m", result()), required("chosen", boolean())})));
}

Schema improvements_schema() {
  return list(open(map({required("step", text(), "shortest_route | corners | routes | stops | refinement"),
                        required("energy_J", result()), required("duration_s", result()),
                        required("cost_J", result(), "energy, and time at the leg's price")})));
}

constexpr const char* kBoundMeans =
    "no profile of these paths within the limits takes less; null where one is driven in the least time";
constexpr const char* kWithoutJerk =
    "the bound, drafts and the choice of ways leave the jerk limit out: the gap holds its price, too";

constexpr const char* kPathBoundMeans =
    "no path of any kind from stop to stop takes less in this time, driving backward only where the robot "
    "states a speed for it, without the jerk limit, in the order of the stops and along given paths; null "
    "where "
    "not covered";
constexpr const char* kPathGapMeans = "to that bound, relative to the energy";
constexpr const char* kPathPartMeans =
    "line | headings | corners: what the bound rests on, on the leg with the widest gap; headings: those at "
    "the ends raise it; corners: it takes the way around them as straight";
constexpr const char* kPathReasonMeans = "reason why that bound is null";

Schema leg_result_schema() {
  return open(
      map({required("to", text()),
           required("status", plan_status()),
           required("energy_J", result()),
           optional("energy_interval_95_J", interval(), "from the robot file's uncertainty"),
           optional("lower_bound_J", result(), kBoundMeans),
           optional("optimality_gap_percent", result(),
                    "on this path, relative to the energy; for least time, relative to the time"),
           optional("bound_without_jerk", boolean(), kWithoutJerk),
           optional("path_lower_bound_J", result(), kPathBoundMeans),
           optional("path_gap_percent", result(), kPathGapMeans),
           optional("path_bound_part", text(), kPathPartMeans),
           optional("path_bound_reason", text(), kPathReasonMeans),
           optional("far_above_path_bound", boolean(),
                    "the gap is large, without corners that explain it: another seed or a stop on the "
                    "way may be cheaper"),
           optional("charged_J", result(), "at the charger of an inserted stop"),
           required("duration_s", result(), "without dwell"),
           required("distance_m", result()),
           required("payload_kg",
                    any_of({number(), open(map({required("from", number()), required("to", number())}))})),
           required("price_of_time_W", result(), "-dE/dT: the energy that one more second would save"),
           required("energy_by_cause_J", causes_schema()),
           required("baselines", baselines_schema()),
           optional("alternatives", alternatives_schema(),
                    "candidate ways, turns included; scored without the jerk limit"),
           optional("improvements", improvements_schema(),
                    "the leg after each step of choosing its way, without the jerk limit")}));
}

Schema battery_result_schema() {
  return open(
      map({required("start_fraction", result()), required("end_fraction", result()),
           required("interval_95", nullable(interval()), "of the end fraction; null: unknown"),
           required("required_capacity_Wh", result(),
                    "95 % upper bound where the interval holds the model's error"),
           required("missions_per_charge", result()),
           optional("voltage_error_V", result(),
                    "with an open-circuit curve: how far the voltage on a leg is at most from the one "
                    "with which the leg was planned"),
           optional("open_circuit_voltage_on_leg_V", list(number()),
                    "with an open-circuit curve: the voltage with which each leg was planned")}));
}

Schema winding_result_schema() {
  const Schema sides = open(map({required("left", number()), required("right", number())}));
  return open(map({required("highest_C", result()), required("side", choice({"left", "right"})),
                   required("above_limit_K", result(), "negative: that much below max_winding_C"),
                   required("price_of_heat", result(),
                            "joules that a joule of copper loss counted beside itself, so that the limit is "
                            "kept"),
                   optional("planned_current_A", sides,
                            "the greatest currents of the plan, where it keeps the limit by them"),
                   required("highest_on_leg_C", list(sides)), required("after_leg_C", list(sides)),
                   required("resistance_factor_on_leg", list(sides),
                            "of the copper relative to the cold one, with which the leg was planned")}));
}

Schema confidence_schema() {
  return open(map(
      {required("asked", result()), required("draws", integer(), "robots, from the file's uncertainty"),
       optional("kept", result(), "share of the draws that keep all promises"),
       optional("kept_at_least", result(), "one-sided 95 % lower bound of the probability"),
       optional("promises", list(open(map({required("name", text(), "arrival, reserve, or a limit"),
                                           required("kept", result()),
                                           required("binds", boolean(), "a margin is left, and used up")})))),
       optional("limit_shares", dictionary(result()), "of the limits, that the plan uses at most"),
       optional("reserve_margin_fraction", result(), "state of charge left above the reserve"),
       required("kept_without_margins", result(), "share of the draws that a plan without margins keeps"),
       required("energy_without_margins_J", result()), required("duration_without_margins_s", result())}));
}

Schema infeasibility_schema() {
  return open(
      map({required("constraint", text()), required("leg", integer()), optional("to", text()),
           required("arc_length_m", result()), required("x_m", result()), required("y_m", result()),
           required("amount", result()), required("unit", text()),
           required("relaxation", dictionary(result()), "the smallest change that makes it feasible")}));
}

Schema gap_schema() {
  const Schema energy = open(
      map({required("before_percent", result()), required("after_percent", result()),
           required("bias_before_percent", result(), "predicted - measured; negative: the model is too low"),
           required("noise_floor_percent", result()), required("before_J", result()),
           required("after_J", result()), required("shrink_fraction", result()),
           required("shrink_interval_95", interval()),
           optional("hard_to_see",
                    list(open(map({required("effect", text()),
                                   required("detectable_percent", result(), "null: no size is seen")}))),
                    "without a gap: effects that these runs show only above 3 % of the energy")}));
  return open(map({required("energy", energy, "of the motors; at the battery where nothing measures them"),
                   optional("battery_energy", energy, "at the battery, where both are measured"),
                   optional("current", open(map({}))), optional("voltage", open(map({}))),
                   optional("motion", open(map({})))}));
}

Schema runs_apart_schema() {
  return list(open(
      map({required("run", text()),
           required("over_model_percent", result(), "measured energy over the others' model, less 100 %"),
           required("share_of_gap", result(), "of all runs, with the robot file's model")})));
}

Schema where_schema() {
  return list(open(
      map({required("axis", choice({"phase", "wheel", "speed", "payload", "floor", "heading", "direction",
                                    "time_of_day", "channel", "run", "path", "acceleration"})),
           required("value", text()), required("share_of_gap", result()), required("energy_J", result()),
           required("interval_95", interval()),
           optional("bias_percent", result(), "predicted - measured, of the cell's energy")})));
}

Schema cause_schema() {
  const Schema parameter = any_of(
      {open(map({required("value", any_of({result(), text()})), optional("interval_95", interval())}))});
  return open(
      map({required("effect", text()), required("probability", number(kFraction)),
           required("indistinguishable_from", list(text())), required("parameters", dictionary(parameter)),
           required("energy_share", result()), required("shrink_fraction_alone", result())}));
}

Schema simulator_schema() {
  return open(map(
      {required("runs", integer(kNotNegative), "that it predicts"),
       required("of_runs", integer(kNotNegative), "with a usable log"),
       required("gap_percent", result(), "of the energy of the measured motion, over all these runs"),
       required("bias_percent", result()), required("noise_floor_percent", result()),
       required("contents_verdict", choice(verdict_names()), "of its predictions against the robot file"),
       required("contains", list(cause_schema()), "effects that it has beyond the robot file"),
       required("another_robots_file", boolean(), "the robot file does not describe what it simulates"),
       required("aligned_by",
                open(map({required("time", integer(kNotNegative)), required("command", integer(kNotNegative)),
                          required("path", integer(kNotNegative))})),
                "runs by what aligns them"),
       required("clock_offset_s", result(), "of its commands after the robot's, the greatest"),
       required("motion_difference_percent", result(), "of the wheel speeds (rms) after that, the greatest"),
       required("lacking_channels", list(text()), "compared with this program's model instead"),
       optional("logs",
                list(open(map({required("run", text()), required("content", text()),
                               required("predicted_content", text())}))),
                "what was compared, with hashes of the content"),
       optional("velocity_filter_s", number(), "of the filter behind which its wheel speeds are"),
       required("sentence", text())}));
}

Schema isolability_schema() {
  return open(map(
      {required("effects",
                list(open(map({required("effect", text()),
                               required("probability_seen", number(kFraction), "at its usual size"),
                               optional("seen_from", dictionary(result()),
                                        "strength with a probability of 0.9; empty: none"),
                               optional("found", boolean(), "named, in a group, or below_materiality")})))),
       required("not_seen", list(text()), "effects with a probability below 0.9 that were not found"),
       required("not_told_apart",
                list(open(map(
                    {required("effect", text()), required("other", text()),
                     required("two_ln_likelihood_ratio", result(), "expected, against the other's best fit"),
                     required("probability_told_apart", number(kFraction))}))),
                "pairs with a probability below 0.9; every other pair of seen effects has a higher one"),
       required("groups", list(list(text())), "sets whose members the runs cannot separate")}));
}

Schema unknowns_schema() {
  return list(
      open(map({required("depends_on", text()), required("probability", number(kFraction)),
                required("share", result(), "fraction of the explained gap that is lost without it")})));
}

Schema below_materiality_schema() {
  return list(open(map({required("effect", text()), required("probability", number(kFraction)),
                        required("evidence", result(), "natural log of the odds"),
                        required("size", result(), "ratio to the materiality floor")})));
}

Schema data_checks_schema() {
  return list(open(map({required("run", text(), "names, or `all`"), required("channel", text()),
                        required("kind", text(), "dead | inverted | swapped | unit | scaled | clock"),
                        required("evidence", text()), required("repair", text())})));
}

Schema foreign_constants_schema() {
  return list(open(map({required("constant", text()), required("unit", text()), required("in_file", result()),
                        required("in_runs", result())})));
}

Schema signals_schema() {
  return list(open(map({required("name", text()), required("use", text(), "diagnosis | validation"),
                        required("columns", dictionary(list(number())),
                                 "time_s; motion_X: a signal X of the motion; measured_X, predicted_X, "
                                 "corrected_X for each signal X")})));
}

}  // namespace

Schema plan_schema() {
  return open(map(
      {required("schema", text()),
       required("status", plan_status()),
       optional(
           "robot",
           open(map({required("name", text()),
                     required("fingerprint", text(),
                              "digest of the robot file's values, without its name and its uncertainty")})),
           "robot of the plan"),
       optional("energy_J", result(), "at the battery's terminals, dwell and standby included"),
       optional("energy_interval_95_J", interval(), "from the robot file's uncertainty"),
       optional("motion_energy_J", result(), "without standby"),
       optional("energy_Wh", result()),
       optional("battery_loss_J", result(), "in the battery's internal resistance, beside energy_J"),
       optional("duration_s", result()),
       optional("distance_m", result()),
       optional("lower_bound_J", result(), kBoundMeans),
       optional("optimality_gap_percent", result(), "on these paths"),
       optional("bound_without_jerk", boolean(), kWithoutJerk),
       optional("path_lower_bound_J", result(), kPathBoundMeans),
       optional("path_gap_percent", result(), kPathGapMeans),
       optional("path_bound_part", text(), kPathPartMeans),
       optional("path_bound_reason", text(), kPathReasonMeans),
       optional("energy_by_cause_J", causes_schema(), "adds up to energy_J"),
       optional("solver", open(map({required("name", text()), required("iterations", number())}))),
       optional("replay", open(map({required("energy_J", result()), required("worst_violation", result()),
                                    required("limit", text())}))),
       optional("battery", battery_result_schema()),
       optional("winding", winding_result_schema()),
       optional("confidence", confidence_schema(), "where one was asked for"),
       optional("legs", list(leg_result_schema())),
       optional("baselines", baselines_schema()),
       optional("infeasibility", infeasibility_schema())}));
}

Schema after_schema() {
  return open(
      map({required("schema", text()), required("sentence", text(), "the answer in one line"),
           required("causes", list(text()), "that the first diagnosis named"),
           required("gap", gap_schema(), "of the simulator before and after its change"),
           required(
               "forecast",
               open(map({required("shrink_fraction", result()), required("shrink_interval_95", interval())})),
               "of the first diagnosis"),
           required("validation", open(map({required("runs", list(text())), required("method", text())})))}));
}

Schema diagnosis_schema() {
  return open(map(
      {required("schema", text()),
       required("gap", gap_schema()),
       optional("simulator", simulator_schema(),
                "the user's own simulator (`predicted:`), which everything else is about"),
       optional("velocity_filter_s", number(),
                "time constant of the filter behind which the wheel speeds are"),
       optional("runs_apart", runs_apart_schema(),
                "runs that no model of the others describes; nothing else here counts them"),
       required("where", where_schema()),
       required("verdict", choice(verdict_names()),
                "on the user's own simulator where it predicts runs, else on the robot file's model"),
       optional("sentence", text(), "the answer in one line"),
       optional("next_step", text(), "what to do next"),
       required("causes", list(cause_schema())),
       required("ranking",
                list(open(map({required("effect", text()), required("probability", number(kFraction))})))),
       optional("unknowns", unknowns_schema(), "causes that no effect of the catalog represents"),
       optional("below_materiality", below_materiality_schema(),
                "effects with evidence, but smaller than the materiality floor"),
       required("leftover", open(map({required("significant", boolean()), required("description", text())}))),
       optional("next_experiment", open(map({}))),
       optional("ceiling", open(map({}))),
       optional("control", open(map({}))),
       optional("pinned_combination", text()),
       optional("correlations",
                list(open(map({required("parameter", text()),
                               required("other", text(), "may be a calibration constant"),
                               required("correlation", result())}))),
                "correlated estimates of the fit"),
       optional("isolability", isolability_schema(),
                "effects that the design of the runs can show, and pairs that it can separate"),
       optional("foreign_constants", foreign_constants_schema(),
                "constants of another robot; with any of them no cause is sought"),
       optional("data_checks", data_checks_schema(),
                "channels that contradict physics; with any of them the verdict is data_suspect"),
       optional("artifacts", list(any_of({text(), open(map({}))}))),
       optional("signals", signals_schema(),
                "with --signals: measured against predicted, before and after the correction"),
       optional("missing_channels", list(text())),
       optional("decisions", open(map({}))),
       optional("validation", open(map({required("runs", list(text())), required("method", text())})))}));
}

}  // namespace joulepath
