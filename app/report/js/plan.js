/** The report of `joulepath plan`. Data: {plan, trajectory: {column: [..]}, overlays: [{name, columns}], limits, map, title}. */
import {button, h, key} from "page/dom.js";
import {at_most_percent, fraction, is_number, number, percent, short, signed, value_at, with_unit, words} from "page/numbers.js";
import {ramp_css} from "page/theme.js";
import {jp} from "report/core.js";
import "report/bars.js";
import "report/map.js";
import "report/plots.js";

/** Places where the robot turns without moving: [{x, y, kind, text}]. */
jp.turns_in_place = function (columns) {
  const {time_s: t, linear_speed_m_s: v = [], angular_speed_rad_s: w = [], position_x_m: x = [], position_y_m: y = []} = columns;
  const turns = [];
  for (let k = 1, angle = 0; k < t.length; ++k) {
    const turning = Math.abs(v[k]) < 1e-4 && Math.abs(w[k]) > 1e-4;
    if (turning) angle += 0.5 * (w[k] + w[k - 1]) * (t[k] - t[k - 1]);
    if ((!turning || k === t.length - 1) && angle !== 0) {
      if (Math.abs(angle) > 0.02) turns.push({x: x[k - 1], y: y[k - 1], kind: "turn", angle_rad: angle, time_s: t[k]});
      angle = 0;
    }
  }
  return turns;
};

/** What a plan saves against a classic profile, and by which causes most of it. */
jp.saved_text = function (saving) {
  const parts = jp.causes(saving.by_cause).filter((cause) => Math.abs(cause.J) > 0.1 * Math.abs(saving.saved_J)).sort((a, b) => Math.abs(b.J) - Math.abs(a.J)).slice(0, 3);
  return parts.map((cause) => `${words(cause.name)} ${signed(cause.J)} J`).join(", ");
};
/** Driving, waiting at stops: a duration holds both. */
jp.time_text = function (plan) {
  const dwell_s = (plan.legs || []).reduce((sum, leg) => sum + (leg.dwell_s || 0), 0);
  return dwell_s > 0 ? `${with_unit(plan.duration_s - dwell_s, "s")} driving, ${with_unit(dwell_s, "s")} dwell` : "no dwell";
};

/** "182.0 s, 2614 J". */
jp.cost_text = (one) => `${with_unit(one.duration_s, "s")}, ${with_unit(one.energy_J, "J", 5)}`;
/** What a drive takes on the plan's path, and what the optimum takes there in the same time. */
jp.against_text = (who, one) => `${who}: ${jp.cost_text(one)}. Same path and time, optimal: ${with_unit(one.optimum_J, "J", 5)} (${percent(100 * (1 - one.optimum_J / one.energy_J), 2)} less).`;

jp.plan_sentence = function (plan) {
  const best = (plan.baselines || []).find((one) => one.name === "trapezoid_best_tuned" && one.feasible !== false && is_number(one.optimum_J));
  return (best ? jp.against_text("The best tuned trapezoid", best) + " " : "") + `The plan: ${jp.cost_text(plan)}.`;
};

/** Energy of a year, and its price, where the missions of a day are known; else the missions of a battery charge. */
jp.operation_tile = function (data) {
  const {plan, missions_per_day, price_per_kWh: price} = data, battery = plan.battery, kWh = 365 * missions_per_day * plan.energy_Wh / 1000;
  if (is_number(kWh)) return jp.tile("Energy of a year", with_unit(kWh, "kWh"), `${short(missions_per_day)} missions a day` + (is_number(price) ? `; ${number(kWh * price)} at ${short(price)} per kWh` : ""));
  return battery && battery.missions_per_charge ? jp.tile("Missions per charge", short(Math.floor(battery.missions_per_charge), 7), `${with_unit(battery.missions_per_charge * plan.distance_m / 1000, "km", 3)} per charge`) : null;
};

/** How good the plan is, in one line. */
jp.quality_text = function (plan) {
  const parts = [is_number(plan.optimality_gap_percent) ? `speed profile within ${at_most_percent(plan.optimality_gap_percent)}${jp.bound_text(plan)}` : "", is_number(plan.path_gap_percent) ? `path within ${at_most_percent(plan.path_gap_percent)} of any path` : ""].filter(Boolean);
  return parts.length ? h("p", {class: "soft small"}, "Of the least energy: " + parts.join(", ") + ".") : null;
};

/** What the bound leaves out. */
jp.bound_text = (plan) => (plan.bound_without_jerk ? " without the jerk limit" : "");

/** The first row: what it takes, what that saves and by which causes, how long it lasts, how good it is. */
jp.plan_tiles = function (data) {
  const plan = data.plan, savings = data.savings || [];
  const against = (plan.baselines || []).filter((one) => is_number(one.saving_percent) && one.feasible !== false);
  const tiles = [jp.tile("Energy at the battery", with_unit(plan.energy_J, "J"), `${with_unit(plan.energy_Wh, "Wh")}; motion alone ${with_unit(plan.motion_energy_J, "J")}`)];
  against.forEach((one) => {
    const saving = savings.find((entry) => entry.name === one.name);
    tiles.push(jp.tile("Saved against " + words(one.name), with_unit(one.energy_J - one.optimum_J, "J", 3), [h("div", {}, `${percent(one.saving_percent)}; ${percent(one.motion_saving_percent)} of motion energy` + (one.later_s ? `, both in ${with_unit(one.duration_s, "s")}` : "")), saving ? h("div", {}, jp.saved_text(saving)) : null]));
  });
  tiles.push(jp.tile("Duration", with_unit(plan.duration_s, "s"), jp.time_text(plan)), jp.tile("Distance", with_unit(plan.distance_m, "m")));
  tiles.push(jp.operation_tile(data));
  const battery = plan.battery;
  if (battery && is_number(battery.end_fraction)) tiles.push(jp.tile("Battery left", fraction(battery.end_fraction, 4), "from " + fraction(battery.start_fraction, 4)));
  return h("div", {class: "tiles"}, tiles);
};

jp.infeasibility_box = function (plan) {
  const why = plan.infeasibility;
  if (!why) return null;
  const relax = Object.entries(why.relaxation || {}).map(([key, value]) => jp.key_value(key, value, 6)).join(", ");
  return h("div", {class: "notice", role: "alert"}, why.message ? h("div", {}, why.message) : null,
    h("div", {}, `At ${with_unit(why.arc_length_m, "m")} of the leg (x ${number(why.x_m)}, y ${number(why.y_m)}).`),
    relax ? h("div", {}, "Smallest change that works: " + relax + ".") : null);
};

jp.energy_section = function (plan) {
  const causes = jp.causes(plan.energy_by_cause_J);
  if (!causes.length) return null;
  const legs = plan.legs || [], total = plan.energy_J;
  const most = Math.max(...legs.map((leg) => leg.energy_J || 0), 1e-9);
  const negative = causes.filter((cause) => cause.J < 0).map((cause) => `${words(cause.name)} ${with_unit(cause.J, "J")}`);
  const names = causes.map((cause) => cause.name);
  const row_of = (label, by_cause, energy) => {
    const found = Object.fromEntries(jp.causes(by_cause).map((cause) => [cause.name, cause.J]));
    return [label, ...names.map((name) => ({n: number(found[name] ?? 0)})), {n: number(energy)}];
  };
  const color_of = Object.fromEntries(causes.map((cause) => [cause.name, cause]));
  const recolor = (list) => list.map((cause) => ({...cause, ...(color_of[cause.name] ? {color: color_of[cause.name].color, ink: color_of[cause.name].ink} : {})}));
  return jp.section("Energy by cause",
    h("div", {class: "scale"}, causes.map((cause) => key(words(cause.name), cause.color, "box"))),
    h("h3", {}, `Mission, ${with_unit(total, "J")}`), jp.stacked_bar(causes, causes.reduce((sum, cause) => sum + Math.max(0, cause.J), 0) || 1),
    negative.length ? h("p", {class: "soft small"}, "Negative, not drawn: " + negative.join(", ")) : null,
    legs.length > 1 ? [h("h3", {}, "Legs, on one scale"), h("div", {class: "rows"}, legs.flatMap((leg, k) => [h("span", {}, jp.leg_name(leg, k)),
      jp.stacked_bar(recolor(jp.causes(leg.energy_by_cause_J)), most), h("span", {class: "n"}, with_unit(leg.energy_J, "J"))]))] : null,
    h("details", {}, h("summary", {}, "Numbers, in J"), jp.table(["", ...names.map((name) => ({n: words(name)})), {n: "total"}],
      [...legs.map((leg, k) => row_of(jp.leg_name(leg, k), leg.energy_by_cause_J, leg.energy_J)), row_of("mission", plan.energy_by_cause_J, total)])));
};
/** Legs are counted from 1, in keys and JSON from 0. */
jp.leg_name = (leg, k) => `${k + 1} ${leg.to && leg.to !== "path" && leg.to !== "motion" ? "to " + leg.to : leg.to || "path"}`;

jp.baseline_section = function (plan) {
  const baselines = (plan.baselines || []).filter((one) => one.name);
  if (!baselines.length) return null;
  const counted = baselines.filter((one) => one.feasible !== false && is_number(one.energy_J));
  const rows = [{name: "this plan", energy_J: plan.energy_J, motion_energy_J: plan.motion_energy_J, duration_s: plan.duration_s}, ...baselines];
  return jp.section("Against classic profiles", h("p", {class: "soft"}, "Same path, same time: a profile that is later than the plan is compared with the least energy in its own time. Percentages are of the profile's energy. Savings are of the model's energy; a diagnosis measures the model's own error."),
    h("h3", {}, "Motion energy, and its excess over the least in the same time"), jp.difference_rows(counted.map((one) => ({label: jp.profile_name(one), value: one.motion_energy_J, base: one.optimum_motion_J})), "J"),
    jp.table(["profile", {n: "energy J"}, {n: "motion J"}, {n: "time s"}, {n: "least J in it"}, {n: "saving"}, {n: "of motion"}, ""], rows.map((one) => one.feasible === false
      ? [words(one.name), {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, "infeasible: " + (one.reason || "exceeds a limit")]
      : [words(one.name), {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.duration_s)}, {n: number(one.optimum_J, 6)}, {n: percent(one.saving_percent)}, {n: percent(one.motion_saving_percent)},
        [one.later_s ? number(one.later_s, 2) + " s later than the plan (the plan's time is infeasible for this profile)" : null, ...Object.entries(one.parameters || {}).map(([key, value]) => jp.key_value(key, value))].filter(Boolean).join(", ")])), jp.settings_details(plan));
};

/** Settings of the baselines per leg and stretch, for controllers that follow only trapezoids. */
jp.settings_details = function (plan) {
  const rows = (plan.legs || []).flatMap((leg, k) => (leg.baselines || []).flatMap((one) => (one.stretches || []).map((settings, n) =>
    [jp.leg_name(leg, k), {n: String(n + 1)}, words(((leg.stretches || [])[n] || {}).kind || ""), words(one.name), Object.entries(settings).map(([key, value]) => jp.key_value(key, value)).join(", ")])));
  return rows.length ? h("details", {}, h("summary", {}, "Settings of the trapezoids for each stretch"), jp.table(["leg", {n: "stretch"}, "", "profile", "settings"], rows)) : null;
};

jp.legs_section = function (plan) {
  const legs = plan.legs || [];
  if (!legs.length) return null;
  const payload = (value) => (value && typeof value === "object" ? `${number(value.from)} to ${number(value.to)}` : number(value));
  const weighed = legs.flatMap((leg, k) => (leg.alternatives || []).map((way) => [jp.leg_name(leg, k), words(way.name) + (way.chosen ? " (chosen)" : ""), {n: number(way.energy_J, 5)}, {n: number(way.duration_s)}, {n: number(way.distance_m)}]));
  const band = (ends) => (ends && is_number(ends[0]) && ends[1] > ends[0] ? `${number(ends[0], 5)} to ${number(ends[1], 5)}` : "");
  return jp.section("Legs", jp.table(["leg", "on its path", {n: "payload kg"}, {n: "distance m"}, {n: "driving s"}, {n: "dwell s"}, {n: "energy J"}, {n: "95 % interval J"}, {n: "value of a second, W"}],
    legs.map((leg, k) => [jp.leg_name(leg, k), words(leg.status), {n: payload(leg.payload_kg)}, {n: number(leg.distance_m)}, {n: number(leg.duration_s)}, {n: leg.dwell_s > 0 ? number(leg.dwell_s) : "–"}, {n: number(leg.energy_J, 5)}, {n: band(leg.energy_interval_95_J)}, {n: number(leg.price_of_time_W, 3)}])),
    weighed.length ? h("details", {}, h("summary", {}, `Candidate ways${plan.bound_without_jerk ? ", costed without the jerk limit" : ""}`), jp.table(["leg", "way", {n: "energy J"}, {n: "time s"}, {n: "distance m"}], weighed)) : null);
};

/** The same legs as planned, with all limits. */
jp.planned_row = function (legs) {
  const sum = (of) => legs.reduce((all, leg) => all + (leg.stretches || []).reduce((part, one) => part + of(one, leg), 0), 0), J = sum((one) => one.energy_J);
  return ["the plan, with all limits", {n: number(J, 5)}, {n: number(sum((one) => one.duration_s))}, {n: number(J + sum((one, leg) => leg.price_of_time_W * one.duration_s), 5)}];
};

/* The mission after each step of choosing its ways: sums over the legs, at their prices of a second. */
jp.ways_section = function (plan) {
  const legs = (plan.legs || []).filter((leg) => (leg.improvements || []).length);
  if (!legs.length) return null;
  const says = {shortest_route: "shortest route, stop, turn, go", corners: "arcs at corners", routes: "route by energy", stops: "arcs at stops", refinement: "control points moved"};
  const sum = (step, key) => legs.reduce((all, leg) => all + ((leg.improvements.find((one) => one.step === step) || {})[key] || 0), 0);
  const steps = legs[0].improvements.map((one) => one.step);
  return jp.section("Choice of ways", h("p", {class: "soft"}, `Sums over the ${legs.length} legs whose way was searched, driving alone, without dwell.${plan.bound_without_jerk ? " These steps leave the jerk limit out: the plan, which keeps it, takes more." : ""}`), jp.table(["after", {n: "energy J"}, {n: "driving s"}, {n: "energy plus time at its price, J"}],
    [...steps.map((step) => [says[step] || words(step), {n: number(sum(step, "energy_J"), 5)}, {n: number(sum(step, "duration_s"))}, {n: number(sum(step, "cost_J"), 5)}]), jp.planned_row(legs)]));
};

jp.battery_section = function (plan) {
  const battery = plan.battery;
  if (!battery || !is_number(battery.end_fraction)) return null;
  const interval = battery.interval_95;
  return jp.section("Battery",
    h("p", {}, [`From ${fraction(battery.start_fraction, 5)} to ${fraction(battery.end_fraction, 5)}. `, interval ? `95 % interval of the end: ${fraction(interval[0], 5)} to ${fraction(interval[1], 5)}. ` : "", typeof plan.uncertainty === "string" ? `Uncertainty ${plan.uncertainty}. ` : "",
      is_number(battery.required_capacity_Wh) ? `Capacity needed: ${with_unit(battery.required_capacity_Wh, "Wh")}. ` : "",
      is_number(battery.missions_per_charge) ? `Missions per charge: ${short(Math.floor(battery.missions_per_charge), 7)}. ` : "",
      is_number(battery.voltage_error_V) ? `Each leg is planned with the voltage at its least charge, at most ${with_unit(battery.voltage_error_V, "V", 2)} from the open-circuit curve. ` : "",
      battery.charged_J > 0 ? `Charged on the way: ${with_unit(battery.charged_J, "J")}. ` : "",
      is_number(plan.battery_loss_J) ? `Lost inside the battery: ${with_unit(plan.battery_loss_J, "J")}.` : ""].join("")));
};

/** The temperatures of the windings, leg by leg. */
jp.winding_section = function (plan) {
  const winding = plan.winding;
  if (!winding || !is_number(winding.highest_C)) return null;
  const both = (list, leg) => [{n: number(list[leg].left, 4)}, {n: number(list[leg].right, 4)}];
  return jp.section("Windings",
    h("p", {}, `Up to ${with_unit(winding.highest_C, "°C")} (${winding.side}), ${with_unit(-winding.above_limit_K, "K", 3)} below the limit.` + (winding.price_of_heat > 0 ? ` The plan is slower for it: a joule of copper loss counts ${number(1 + winding.price_of_heat, 3)} times.` : "") + (winding.planned_current_A ? ` The plan is slower for it: at most ${with_unit(winding.planned_current_A.left, "A", 4)} left and ${with_unit(winding.planned_current_A.right, "A", 4)} right.` : "")),
    jp.table(["leg", {n: "hottest left °C"}, {n: "right"}, {n: "after the stop left °C"}, {n: "right"}],
      (plan.legs || []).map((leg, k) => [jp.leg_name(leg, k), ...both(winding.highest_on_leg_C, k), ...both(winding.after_leg_C, k)])));
};

/** With what probability the promises are kept together, and what that costs. */
jp.confidence_section = function (plan) {
  const account = plan.confidence;
  if (!account || !is_number(account.kept)) return null;
  const kept = (share) => (share > 0.999 ? "> 99.9 %" : percent(100 * share, 3)), costs = [plan.energy_J - account.energy_without_margins_J, plan.duration_s - account.duration_without_margins_s];
  const margins = Object.keys(account.limit_shares || {}).length > 0 || account.reserve_margin_fraction > 0;
  return jp.section("Confidence",
    h("p", {}, `${kept(account.kept)} of ${account.draws} robots, drawn from the robot file's uncertainty, keep all promises; the probability is above ${percent(100 * account.kept_at_least, 4)}, asked for were ${percent(100 * account.asked, 4)}. ` +
      (margins ? `This takes ${with_unit(costs[0], "J", 3)} and ${with_unit(costs[1], "s", 3)} more than the plan without margins, which ${kept(account.kept_without_margins)} of them keep.` : "The plan needs no margins for it.")),
    jp.table(["promise", {n: "kept"}, {n: "share of the limit used at most"}, ""],
      (account.promises || []).map((one) => [words(one.name), {n: kept(one.kept)}, {n: is_number((account.limit_shares || {})[one.name]) ? percent(100 * account.limit_shares[one.name], 3) : ""}, one.binds ? "binds" : ""])),
    h("p", {class: "soft"}, "The robot tracks the planned speed; it is late only where a limit of motors, battery or tires saturates."));
};

/** What each gap means, for readers who know neither. */
jp.gap_texts = function (plan) {
  const texts = (plan.legs || []).flatMap((leg, k) => leg.far_above_path_bound ? [`Other paths of leg ${jp.leg_name(leg, k)} may save up to ${at_most_percent(leg.path_gap_percent)}, with no corner to explain it: another seed or a stop on the way may be cheaper.`] : []);
  if (is_number(plan.optimality_gap_percent)) texts.push("The gap on these paths is how much energy a better speed profile on the same paths could save at most.");
  const bounded = (plan.legs || []).flatMap((leg, k) => is_number(leg.path_gap_percent) ? [`${jp.leg_name(leg, k)} ${at_most_percent(leg.path_gap_percent)}`] : []);
  if (bounded.length) texts.push("The gap to any path is how much energy any other paths between the same stops, driven at any speeds in this time, could save at most; what can really be saved is usually far less." + (plan.bound_without_jerk ? " Jerk limits are left out." : "") + (plan.legs.length > 1 ? ` Of the legs: ${bounded.join(", ")}.` : "") + (plan.path_bound_part === "corners" ? " It counts the shortest ways around obstacles as if they were straight, so part of it is the price of corners." : plan.path_bound_part === "headings" ? " It knows the headings at the stops, but not that the yaw rate takes time to change." : plan.path_bound_part === "line" ? " It is that of straight lines: headings at the stops do not raise it." : ""));
  return texts;
};

jp.trust_section = function (plan) {
  const rows = [["status on these paths", words(plan.status)]];
  if (is_number(plan.optimality_gap_percent)) rows.push(["gap to their optimum" + jp.bound_text(plan), at_most_percent(plan.optimality_gap_percent)]);
  if (is_number(plan.path_gap_percent)) rows.push(["gap to any path", at_most_percent(plan.path_gap_percent)]);
  else if (plan.path_bound_reason) rows.push(["gap to any path", "unknown: " + plan.path_bound_reason]);
  if (plan.replay) rows.push(["energy by the replay (its own integrator)", with_unit(plan.replay.energy_J, "J", 7)],
    ["worst violation of a limit, relative", number(plan.replay.worst_violation, 2) + (plan.replay.limit ? ` (${words(plan.replay.limit)})` : "")]);
  if (plan.solver) rows.push(["solver", `${plan.solver.name}, ${plan.solver.iterations} iterations`]);
  return rows.length > 1 ? jp.section("Verification", jp.table(["", ""], rows), jp.gap_texts(plan).map((text) => h("p", {class: "soft"}, text))) : null;
};

/** Plots of the motion with the baselines beside it, and limits. */
jp.motion_plots = function (data, axis, cursor) {
  const c = data.trajectory, limits = data.limits || {}, plots = [];
  const line = (name, column, color, look = {}) => (c[column] ? [{name, xs: () => axis.of(c), values: c[column], color, ...look}] : []);
  const overlay = (column) => (data.overlays || []).filter((one) => one.columns[column]).map((one, k) => ({name: words(one.name), xs: () => axis.of(one.columns), values: one.columns[column], color: ["second", "third", "fifth"][k % 3], dash: [5, 3], width: 1.2}));
  const limit_line = (name, column) => line(name, column, "limit", {dash: [7, 4], width: 1.2});
  // A band has instants of its own; over the distance they lie where the motion is then.
  const along = (band) => axis.of(c) === c.time_s ? band.time_s : band.time_s.map((t) => value_at(c.time_s, axis.of(c), t));
  const banded = (list, name, scale = 1) => { const band = (data.bands || {})[name]; return list.map((one) => (band ? {...one, band: {xs: () => along(band), low: band.low.map((y) => scale * y), high: band.high.map((y) => scale * y)}} : one)); };
  const banded_line = (name, text, scale = 1) => { const band = (data.bands || {})[name]; return band ? banded([{name: text, xs: () => along(band), values: band.value.map((y) => scale * y), color: "plan"}], name, scale) : []; };
  const add = (title, unit, series, limit_values = [], fitted = false) => series.length && plots.push(jp.plot({title, unit, fitted, series, limits: limit_values.filter(is_number), x: () => axis.of(c), cursor}));
  add("Speed", "m/s", [...overlay("linear_speed_m_s"), ...line("plan", "linear_speed_m_s", "plan"), ...limit_line("limit", "limit_speed_m_s")], c.limit_speed_m_s ? [] : [limits.speed_m_s]);
  add("Acceleration", "m/s²", [...overlay("linear_acceleration_m_s2"), ...line("plan", "linear_acceleration_m_s2", "plan"), ...limit_line("limit", "limit_acceleration_m_s2"), ...limit_line("limit, braking", "limit_deceleration_m_s2")],
    c.limit_acceleration_m_s2 ? [] : [limits.acceleration_m_s2, -limits.deceleration_m_s2]);
  add("Yaw rate", "rad/s", line("plan", "angular_speed_rad_s", "plan"), [limits.yaw_rate_rad_s, -limits.yaw_rate_rad_s]);
  add("Wheel torque", "N m", [...line("left", "wheel_torque_left_Nm", "plan"), ...line("right", "wheel_torque_right_Nm", "second")]);
  add("Power", "W", [...banded(line("battery", "battery_power_W", "plan"), "battery_power_W"), ...line("motor left", "motor_power_left_W", "third"), ...line("motor right", "motor_power_right_W", "second")], [limits.battery_power_W]);
  add("Energy", "J", [...overlay("energy_J"), ...banded(line("plan", "energy_J", "plan"), "energy_J")]);
  add("State of charge", "%", banded_line("battery_fraction", "battery", 100), [], true);
  add("Winding temperature", "°C", banded_line("winding_C", ((data.plan.winding || {}).side || "") + " motor"), [], true);
  return plots;
};

jp.motion_section = function (data) {
  const c = data.trajectory;
  if (!c || !c.time_s || !c.time_s.length) return null;
  const t = c.time_s, s = jp.distance(c), v = c.linear_speed_m_s || [], turns = jp.turns_in_place(c);
  const describe = (row) => `t ${number(t[row], 4)} s · ${number(s[row], 4)} m · leg ${(c.leg ? c.leg[row] : 0) + 1} · ${number(v[row], 3)} m/s` +
    (c.battery_power_W ? ` · ${number(c.battery_power_W[row], 3)} W` : "") + (c.energy_J ? ` · ${number(c.energy_J[row], 4)} J` : "") + (c.payload_kg ? ` · payload ${number(c.payload_kg[row], 3)} kg` : "");
  const cursor = jp.cursor(t.length, describe), axis = jp.axis(cursor), plots = jp.motion_plots(data, axis, cursor);
  const map = c.position_x_m ? jp.floor_map({grid: data.map, x: c.position_x_m, y: c.position_y_m, heading: c.heading_rad, speed: v, marks: jp.station_marks(jp.goals_of(data.plan), c, turns), cursor}) : null;
  const scale = h("span", {class: "ramp"});
  jp.redraws.push(() => { scale.style.background = ramp_css(); });
  const whole = button("Whole map", () => { const on = whole.getAttribute("aria-pressed") !== "true"; whole.setAttribute("aria-pressed", String(on)); map.show_whole(on); }, {"aria-pressed": "true"});
  const section = jp.section("The motion", h("div", {class: "side"},
    map ? h("div", {class: "stay"}, map.element, h("div", {class: "scale"}, "0", scale, with_unit(v.reduce((a, b) => Math.max(a, Math.abs(b)), 0), "m/s", 3), " ↻ turn in place" + (v.some((one) => one < 0) ? "; light core: in reverse" : ""), data.map ? whole : null),
      turns.length ? h("p", {class: "soft small"}, `${turns.length} turn${turns.length > 1 ? "s" : ""} in place: ` + turns.map((turn) => number(turn.angle_rad * 180 / Math.PI, 3) + "°").join(", ")) : null) : null,
    h("div", {}, axis.element, cursor.element, h("div", {class: "plots"}, plots.map((one) => one.element)))));
  section.classList.add("long");
  return section;
};

jp.goals_of = (plan) => (plan.legs || []).map((one) => one.to);
/** Start and goals of a way. */
jp.station_marks = function (goals, c, turns) {
  const leg = c.leg || [], marks = [...turns];
  const x = c.position_x_m || [], y = c.position_y_m || [];
  if (x.length) marks.push({x: x[0], y: y[0], kind: "station", text: "start"});
  for (let k = 1; k <= x.length; ++k) {
    if (k < x.length && leg[k] === leg[k - 1]) continue;
    const at = leg[k - 1] ?? 0;
    marks.push({x: x[k - 1], y: y[k - 1], kind: "station", text: `${at + 1} ${goals[at] || ""}`.trim()});
  }
  return marks;
};
/** Stations, and the place of a problem: by the name of the station there, else by what is exceeded. */
jp.problem_marks = function (stations, why) {
  const marks = stations.map((one) => ({x: one.x_m, y: one.y_m, kind: "station", text: one.name}));
  if (!why || !is_number(why.x_m)) return marks;
  const here = marks.findLast((one) => Math.hypot(one.x - why.x_m, one.y - why.y_m) < 1e-3);
  return [...marks.filter((one) => one !== here), {x: why.x_m, y: why.y_m, kind: "problem", text: here ? here.text : words(why.constraint)}];
};

jp.draw_plan = function (data) {
  const plan = data.plan, good = plan.status === "optimal" || plan.status === "feasible", motion = good ? jp.motion_section(data) : null;
  const floor = !motion && data.map ? jp.floor_map({grid: data.map, marks: jp.problem_marks(data.stations || [], plan.infeasibility), label: "Map with the place of the problem"}).element : null;
  const why = plan.infeasibility || {};
  jp.page(jp.header(data.title || "Plan", good ? jp.plan_sentence(plan) : why.constraint ? `No plan: ${words(why.constraint)} on leg ${jp.leg_name(why, why.leg ?? 0)}, missed by ${with_unit(why.amount, why.unit || "")}.` : `No plan: ${plan.message}.`, plan.status, good), jp.infeasibility_box(plan), good ? [jp.plan_tiles(data), jp.quality_text(plan)] : null,
    motion, floor, jp.baseline_section(plan), jp.energy_section(plan), jp.legs_section(plan), jp.ways_section(plan), jp.confidence_section(plan), jp.battery_section(plan), jp.winding_section(plan), jp.trust_section(plan));
};
