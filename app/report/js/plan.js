/* The report of `joulepath plan`. Data: {plan, trajectory: {column: [..]}, overlays: [{name, columns}], limits, map, title}. */

/** Cumulative distance driven, m, from speed and time: dwells and turns in place add nothing. */
jp.distance = function (columns) {
  const t = columns.time_s, v = columns.linear_speed_m_s || [], s = new Array(t.length).fill(0);
  for (let k = 1; k < t.length; ++k) s[k] = s[k - 1] + 0.5 * (Math.abs(v[k] || 0) + Math.abs(v[k - 1] || 0)) * (t[k] - t[k - 1]);
  return s;
};

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

jp.sample = function (times, values, at) {
  let k = 0;
  return at.map((t) => {
    while (k + 1 < times.length && times[k + 1] < t) ++k;
    if (t > times[times.length - 1] + 1e-9 || t < times[0]) return null;
    const next = Math.min(k + 1, times.length - 1), gap = times[next] - times[k];
    return gap > 0 ? values[k] + (values[next] - values[k]) * (t - times[k]) / gap : values[k];
  });
};

jp.plan_tiles = function (plan) {
  const wh = jp.is_number(plan.energy_Wh) ? plan.energy_Wh : plan.energy_J / 3600;
  const best = (plan.baselines || []).filter((one) => jp.is_number(one.saving_percent) && one.feasible !== false);
  const tiles = [jp.tile("Energy at the battery", jp.with_unit(plan.energy_J, "J"), jp.with_unit(wh, "Wh")),
    jp.tile("Motion alone", jp.with_unit(plan.motion_energy_J, "J"), "without standby"),
    jp.tile("Duration", jp.with_unit(plan.duration_s, "s"), "dwell included"), jp.tile("Distance", jp.with_unit(plan.distance_m, "m"))];
  best.forEach((one) => tiles.push(jp.tile("Saved against " + jp.words(one.name), jp.percent(one.saving_percent), jp.percent(one.motion_saving_percent) + " of motion energy")));
  if (jp.is_number(plan.optimality_gap_percent)) tiles.push(jp.tile("Optimality gap", jp.percent(plan.optimality_gap_percent, 2), "at most this far from the optimum"));
  const battery = plan.battery;
  if (battery && jp.is_number(battery.end_fraction)) tiles.push(jp.tile("Battery left", jp.fraction(battery.end_fraction, 4), "from " + jp.fraction(battery.start_fraction, 4)));
  return jp.h("div", {class: "tiles"}, tiles);
};

jp.infeasibility_box = function (plan) {
  const why = plan.infeasibility;
  if (!why) return null;
  const relax = Object.entries(why.relaxation || {}).map(([key, value]) => jp.key_value(key, value)).join(", ");
  return jp.h("div", {class: "notice", role: "alert"}, jp.h("b", {}, `No plan: ${jp.words(why.constraint)}`),
    jp.h("div", {}, why.message || "", ` Leg ${why.leg ?? 0}, at ${jp.with_unit(why.arc_length_m, "m")} of its path (x ${jp.number(why.x_m)}, y ${jp.number(why.y_m)}), missed by ${jp.with_unit(why.amount, why.unit || "")}.`),
    relax ? jp.h("div", {}, "Smallest change that works: " + relax + ".") : null);
};

jp.energy_section = function (plan) {
  const causes = jp.causes(plan.energy_by_cause_J);
  if (!causes.length) return null;
  const legs = plan.legs || [], total = plan.energy_J;
  const most = Math.max(...legs.map((leg) => leg.energy_J || 0), 1e-9);
  const negative = causes.filter((cause) => cause.J < 0).map((cause) => `${jp.words(cause.name)} ${jp.with_unit(cause.J, "J")}`);
  const names = causes.map((cause) => cause.name);
  const row_of = (label, by_cause, energy) => {
    const found = Object.fromEntries(jp.causes(by_cause).map((cause) => [cause.name, cause.J]));
    return [label, ...names.map((name) => ({n: jp.number(found[name] ?? 0)})), {n: jp.number(energy)}];
  };
  const color_of = Object.fromEntries(causes.map((cause) => [cause.name, cause]));
  const recolor = (list) => list.map((cause) => ({...cause, ...(color_of[cause.name] ? {color: color_of[cause.name].color, ink: color_of[cause.name].ink} : {})}));
  return jp.section("Energy by cause",
    jp.h("div", {class: "scale"}, causes.map((cause) => jp.key(jp.words(cause.name), cause.color, "box"))),
    jp.h("h3", {}, `Mission, ${jp.with_unit(total, "J")}`), jp.stacked_bar(causes, causes.reduce((sum, cause) => sum + Math.max(0, cause.J), 0) || 1),
    negative.length ? jp.h("p", {class: "soft small"}, "Negative, not drawn: " + negative.join(", ")) : null,
    legs.length > 1 ? [jp.h("h3", {}, "Legs, on one scale"), jp.h("div", {class: "rows"}, legs.flatMap((leg, k) => [jp.h("span", {}, jp.leg_name(leg, k)),
      jp.stacked_bar(recolor(jp.causes(leg.energy_by_cause_J)), most), jp.h("span", {class: "n"}, jp.with_unit(leg.energy_J, "J"))]))] : null,
    jp.h("details", {}, jp.h("summary", {}, "Numbers, in J"), jp.table(["", ...names.map((name) => ({n: jp.words(name)})), {n: "total"}],
      [...legs.map((leg, k) => row_of(jp.leg_name(leg, k), leg.energy_by_cause_J, leg.energy_J)), row_of("mission", plan.energy_by_cause_J, total)])));
};
jp.leg_name = (leg, k) => `${k} ${leg.to && leg.to !== "path" && leg.to !== "motion" ? "to " + leg.to : leg.to || "path"}`;

jp.baseline_section = function (plan) {
  const baselines = (plan.baselines || []).filter((one) => one.name);
  if (!baselines.length) return null;
  const counted = baselines.filter((one) => one.feasible !== false && jp.is_number(one.energy_J));
  const rows = [{name: "this plan", energy_J: plan.energy_J, motion_energy_J: plan.motion_energy_J, duration_s: plan.duration_s}, ...baselines];
  return jp.section("Against classic profiles", jp.h("p", {class: "soft"}, "Same path, same time (or the least time of that profile). Savings are of the model's energy; a diagnosis measures the model's own error."),
    jp.h("h3", {}, "Motion energy, without standby"),
    jp.bar_rows(rows.filter((one) => one === rows[0] || counted.includes(one)).map((one, k) => ({label: jp.words(one.name), value: one.motion_energy_J, text: jp.with_unit(one.motion_energy_J, "J"), color: k ? "var(--second)" : "var(--plan)"}))),
    jp.table(["profile", {n: "energy J"}, {n: "motion J"}, {n: "time s"}, {n: "saving"}, {n: "of motion"}, ""], rows.map((one) => one.feasible === false
      ? [jp.words(one.name), {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, "infeasible: " + (one.reason || "exceeds a limit")]
      : [jp.words(one.name), {n: jp.number(one.energy_J, 6)}, {n: jp.number(one.motion_energy_J, 6)}, {n: jp.number(one.duration_s)}, {n: jp.percent(one.saving_percent)}, {n: jp.percent(one.motion_saving_percent)},
        [one.later_s ? jp.number(one.later_s, 2) + " s later than the plan (the plan's time is infeasible for this profile)" : null, ...Object.entries(one.parameters || {}).map(([key, value]) => jp.key_value(key, value))].filter(Boolean).join(", ")])), jp.settings_details(plan));
};

/** Settings of the baselines per leg and stretch, for controllers that follow only trapezoids. */
jp.settings_details = function (plan) {
  const rows = (plan.legs || []).flatMap((leg, k) => (leg.baselines || []).flatMap((one) => (one.stretches || []).map((settings, n) =>
    [jp.leg_name(leg, k), {n: String(n + 1)}, jp.words(((leg.stretches || [])[n] || {}).kind || ""), jp.words(one.name), Object.entries(settings).map(([key, value]) => jp.key_value(key, value)).join(", ")])));
  return rows.length ? jp.h("details", {}, jp.h("summary", {}, "Settings of the trapezoids for each stretch"), jp.table(["leg", {n: "stretch"}, "", "profile", "settings"], rows)) : null;
};

jp.legs_section = function (plan) {
  const legs = plan.legs || [];
  if (!legs.length) return null;
  const payload = (value) => (value && typeof value === "object" ? `${jp.number(value.from)} to ${jp.number(value.to)}` : jp.number(value));
  const weighed = legs.flatMap((leg, k) => (leg.alternatives || []).map((way) => [jp.leg_name(leg, k), jp.words(way.name) + (way.chosen ? " (chosen)" : ""), {n: jp.number(way.energy_J, 5)}, {n: jp.number(way.duration_s)}, {n: jp.number(way.distance_m)}]));
  const band = (ends) => (ends && jp.is_number(ends[0]) && ends[1] > ends[0] ? `${jp.number(ends[0], 5)} to ${jp.number(ends[1], 5)}` : "");
  return jp.section("Legs", jp.table(["leg", "status", {n: "payload kg"}, {n: "distance m"}, {n: "time s"}, {n: "energy J"}, {n: "95 % interval J"}, {n: "value of a second, W"}],
    legs.map((leg, k) => [jp.leg_name(leg, k), jp.words(leg.status), {n: payload(leg.payload_kg)}, {n: jp.number(leg.distance_m)}, {n: jp.number(leg.duration_s)}, {n: jp.number(leg.energy_J, 5)}, {n: band(leg.energy_interval_95_J)}, {n: jp.number(leg.price_of_time_W, 3)}])),
    weighed.length ? jp.h("details", {}, jp.h("summary", {}, "Candidate ways"), jp.table(["leg", "way", {n: "energy J"}, {n: "time s"}, {n: "distance m"}], weighed)) : null);
};

/* The mission after each step of choosing its ways: sums over the legs, at their prices of a second. */
jp.ways_section = function (plan) {
  const legs = (plan.legs || []).filter((leg) => (leg.improvements || []).length);
  if (!legs.length) return null;
  const says = {shortest_route: "shortest route, stop, turn, go", corners: "arcs at corners", routes: "route by energy", stops: "arcs at stops", refinement: "control points moved"};
  const sum = (step, key) => legs.reduce((all, leg) => all + ((leg.improvements.find((one) => one.step === step) || {})[key] || 0), 0);
  const steps = legs[0].improvements.map((one) => one.step);
  return jp.section("Choice of ways", jp.table(["after", {n: "energy J"}, {n: "time s"}, {n: "energy plus time at its price, J"}],
    steps.map((step) => [says[step] || jp.words(step), {n: jp.number(sum(step, "energy_J"), 5)}, {n: jp.number(sum(step, "duration_s"))}, {n: jp.number(sum(step, "cost_J"), 5)}])));
};

jp.battery_section = function (plan) {
  const battery = plan.battery;
  if (!battery || !jp.is_number(battery.end_fraction)) return null;
  const interval = battery.interval_95;
  return jp.section("Battery",
    jp.bar_rows([{label: "at the start", value: battery.start_fraction, text: jp.fraction(battery.start_fraction, 5)},
      {label: "at the end", value: battery.end_fraction, text: jp.fraction(battery.end_fraction, 5), color: "var(--third)", interval}], {most: 1}),
    jp.h("p", {}, [interval ? `95 % interval of the end: ${jp.fraction(interval[0], 5)} to ${jp.fraction(interval[1], 5)}. ` : "",
      jp.is_number(battery.required_capacity_Wh) ? `Capacity needed: ${jp.with_unit(battery.required_capacity_Wh, "Wh")}. ` : "",
      jp.is_number(battery.missions_per_charge) ? `Missions per charge: ${jp.short(Math.floor(battery.missions_per_charge), 7)}. ` : "",
      battery.charged_J > 0 ? `Charged on the way: ${jp.with_unit(battery.charged_J, "J")}. ` : "",
      jp.is_number(plan.battery_loss_J) ? `Lost inside the battery: ${jp.with_unit(plan.battery_loss_J, "J")}.` : ""].join("")));
};

jp.trust_section = function (plan) {
  const rows = [["status", jp.words(plan.status)]];
  if (jp.is_number(plan.optimality_gap_percent)) rows.push(["optimality gap", jp.percent(plan.optimality_gap_percent, 2)]);
  if (plan.replay) rows.push(["energy by the replay (its own integrator)", jp.with_unit(plan.replay.energy_J, "J", 7)],
    ["worst violation of a limit, relative", jp.number(plan.replay.worst_violation, 2) + (plan.replay.limit ? ` (${jp.words(plan.replay.limit)})` : "")]);
  if (plan.solver) rows.push(["solver", `${plan.solver.name}, ${plan.solver.iterations} iterations`]);
  return jp.section("Verification", jp.table(["", ""], rows));
};

jp.motion_section = function (data) {
  const c = data.trajectory;
  if (!c || !c.time_s || !c.time_s.length) return null;
  const t = c.time_s, s = jp.distance(c), v = c.linear_speed_m_s || [], turns = jp.turns_in_place(c);
  const describe = (row) => `t ${jp.number(t[row], 4)} s · ${jp.number(s[row], 4)} m · leg ${c.leg ? c.leg[row] : 0} · ${jp.number(v[row], 3)} m/s` +
    (c.battery_power_W ? ` · ${jp.number(c.battery_power_W[row], 3)} W` : "") + (c.energy_J ? ` · ${jp.number(c.energy_J[row], 4)} J` : "") + (c.payload_kg ? ` · payload ${jp.number(c.payload_kg[row], 3)} kg` : "");
  const cursor = jp.cursor(t.length, describe);
  const limits = data.limits || {}, over = data.overlays || [];
  const overlay = (column) => over.filter((one) => one.columns[column]).map((one, k) => ({name: jp.words(one.name), values: jp.sample(one.columns.time_s, one.columns[column], t), color: ["second", "third", "fifth"][k % 3], dash: [5, 3], width: 1.2}));
  const line = (name, column, color) => (c[column] ? [{name, values: c[column], color}] : []);
  const limit_line = (name, column) => (c[column] ? [{name, values: c[column], color: "limit", dash: [7, 4], width: 1.2}] : []);
  const plots = [];
  const add = (title, unit, series, limit_values) => series.length && plots.push(jp.plot({title, unit, series, limits: (limit_values || []).filter(jp.is_number), x: t, cursor}));
  add("Speed", "m/s", [...line("plan", "linear_speed_m_s", "plan"), ...overlay("linear_speed_m_s"), ...limit_line("limit", "limit_speed_m_s")], c.limit_speed_m_s ? [] : [limits.speed_m_s]);
  add("Acceleration", "m/s²", [...line("plan", "linear_acceleration_m_s2", "plan"), ...overlay("linear_acceleration_m_s2"), ...limit_line("limit", "limit_acceleration_m_s2"), ...limit_line("limit, braking", "limit_deceleration_m_s2")],
    c.limit_acceleration_m_s2 ? [] : [limits.acceleration_m_s2, -limits.deceleration_m_s2]);
  add("Yaw rate", "rad/s", line("plan", "angular_speed_rad_s", "plan"), [limits.yaw_rate_rad_s, -limits.yaw_rate_rad_s]);
  add("Wheel torque", "N m", [...line("left", "wheel_torque_left_Nm", "plan"), ...line("right", "wheel_torque_right_Nm", "second")], []);
  add("Power", "W", [...line("battery", "battery_power_W", "plan"), ...line("motor left", "motor_power_left_W", "third"), ...line("motor right", "motor_power_right_W", "second")], [limits.battery_power_W]);
  add("Energy", "J", [...line("plan", "energy_J", "plan"), ...overlay("energy_J")], []);
  const label_of = (by) => (by === "time" ? "time, s" : "distance, m");
  if (plots.length) plots[plots.length - 1].label("time, s");
  const along = (by) => { plots.forEach((plot) => plot.set_x(by === "time" ? t : s, plot === plots[plots.length - 1] ? label_of(by) : null)); buttons.forEach((b) => b.setAttribute("aria-pressed", String(b.dataset.by === by))); };
  const buttons = ["time", "distance"].map((by) => jp.h("button", {type: "button", "data-by": by, "aria-pressed": String(by === "time"), onclick: () => along(by)}, "Over " + by));
  const marks = jp.station_marks(data, c, turns);
  const map = c.position_x_m ? jp.floor_map({grid: data.map, x: c.position_x_m, y: c.position_y_m, heading: c.heading_rad, speed: v, marks, cursor}) : null;
  const ramp = jp.h("span", {class: "ramp"});
  jp.redraws.push(() => { ramp.style.background = jp.ramp_css(); });
  const whole = jp.h("button", {type: "button", "aria-pressed": "false", onclick: () => { const on = whole.getAttribute("aria-pressed") !== "true"; whole.setAttribute("aria-pressed", String(on)); map.show_whole(on); }}, "Whole map");
  const section = jp.section("The motion", jp.h("div", {class: "side"},
    map ? jp.h("div", {class: "stay"}, map.element, jp.h("div", {class: "scale"}, "0", ramp, jp.with_unit(v.reduce((a, b) => Math.max(a, Math.abs(b)), 0), "m/s", 3), " ↻ turn in place", data.map ? whole : null),
      turns.length ? jp.h("p", {class: "soft small"}, `${turns.length} turn${turns.length > 1 ? "s" : ""} in place: ` + turns.map((turn) => jp.number(turn.angle_rad * 180 / Math.PI, 3) + "°").join(", ")) : null) : null,
    jp.h("div", {}, jp.h("div", {class: "bar-tools"}, ...buttons, jp.h("button", {type: "button", onclick: () => cursor.reset()}, "All")), cursor.element, plots.map((plot) => plot.element))));
  section.classList.add("long");
  return {section, ready() { jp.draw_plots(plots); if (map) map.draw(); }};
};

jp.station_marks = function (data, c, turns) {
  const legs = data.plan.legs || [], leg = c.leg || [], marks = [...turns];
  const x = c.position_x_m || [], y = c.position_y_m || [];
  if (x.length) marks.push({x: x[0], y: y[0], kind: "station", text: "start"});
  for (let k = 1; k <= x.length; ++k) {
    if (k < x.length && leg[k] === leg[k - 1]) continue;
    const name = (legs[leg[k - 1]] || {}).to;
    marks.push({x: x[k - 1], y: y[k - 1], kind: "station", text: `${leg[k - 1] ?? 0} ${name || ""}`.trim()});
  }
  const why = data.plan.infeasibility;
  if (why && jp.is_number(why.x_m)) marks.push({x: why.x_m, y: why.y_m, kind: "problem", text: jp.words(why.constraint)});
  return marks;
};

jp.draw_plan = function (data) {
  const plan = data.plan, good = plan.status === "optimal" || plan.status === "feasible";
  const motion = good ? jp.motion_section(data) : null;
  let failed_map = null;
  if (!motion && data.map) failed_map = jp.floor_map({grid: data.map, marks: jp.station_marks(data, {}, []), whole: true, label: "Map with the place of the problem"});
  jp.page(jp.header(data.title || "Plan", data.subtitle || "Energy-optimal plan", plan.status, good), jp.infeasibility_box(plan), good ? jp.plan_tiles(plan) : null,
    motion ? motion.section : null, failed_map ? failed_map.element : null, jp.energy_section(plan), jp.baseline_section(plan), jp.legs_section(plan), jp.ways_section(plan), jp.battery_section(plan), jp.trust_section(plan));
  if (motion) motion.ready();
};
