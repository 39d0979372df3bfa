/** `joulepath compare`: profiles of one path overlaid. `joulepath front`: energy against time. */
import {h} from "page/dom.js";
import {is_number, number, percent, with_unit, words} from "page/numbers.js";
import {kMarks} from "page/plot.js";
import {jp} from "report/core.js";
import "report/bars.js";
import "report/plan.js";
import "report/plots.js";

const kSeriesColors = ["plan", "second", "third", "fourth", "fifth", "sixth"];
const kSteps = 1200;  // places of the cursor
const kDashes = [null, [6, 3], [2, 2], [9, 3, 2, 3], [12, 4], [4, 4]];
/** The look of the k-th line; lines of the same color have different dashes. */
const look_of = (k) => ({color: kSeriesColors[k % 6], dash: kDashes[(k + Math.floor(k / 6)) % 6]});
/** Marks beside a line of the first color. */
const marks_of = (k) => ({color: kSeriesColors[1 + k % 5], mark: kMarks[k % kMarks.length], points: 4.5});

/** A profile's name, with the seconds by which it is later than what it stands beside. */
jp.profile_name = (one) => words(one.name) + (one.later_s ? `, ${number(one.later_s, 2)} s later` : "");

/** Profiles {name, columns} over time or over distance: speed, acceleration, power, energy. */
jp.overlaid_profiles = function (profiles) {
  const drawn = profiles.filter((one) => one.columns && one.columns.time_s && one.columns.time_s.length);
  if (!drawn.length) return null;
  let axis;
  const end = () => drawn.reduce((most, one) => Math.max(most, axis.of(one.columns).at(-1)), 0), x = () => Array.from({length: kSteps}, (_, k) => end() * k / (kSteps - 1));
  const cursor = jp.cursor(kSteps, (row) => `${axis.label()} ${number(x()[row])}`);
  axis = jp.axis(cursor);
  const make = (title, unit, column) => {
    const series = drawn.map((one, k) => one.columns[column] && {name: jp.profile_name(one), xs: () => axis.of(one.columns), values: one.columns[column], ...look_of(k)}).filter(Boolean);
    return series.length ? jp.plot({title, unit, series, x, cursor}).element : null;
  };
  const plots = [make("Speed", "m/s", "linear_speed_m_s"), make("Acceleration", "m/s²", "linear_acceleration_m_s2"), make("Power", "W", "battery_power_W"), make("Energy", "J", "energy_J")].filter(Boolean);
  const section = jp.section("Profiles", axis.element, cursor.element, h("div", {class: "plots"}, plots));
  section.classList.add("long");
  return section;
};

/** Times of a mission hold the dwell at its stops, which the plots leave out. */
jp.dwell_text = function (listed, profiles) {
  const [first] = listed, [drawn] = profiles;
  const dwell_s = first && drawn && drawn.columns && drawn.columns.time_s ? first.duration_s - drawn.columns.time_s.at(-1) : 0;
  return dwell_s > 0.01 ? ` Times hold ${with_unit(dwell_s, "s", 3)} of dwell, which the plots leave out.` : "";
};

/** Map and path of the page's plan. */
jp.way_map = function (data) {
  const c = data.trajectory;
  if (!c || !c.position_x_m) return null;
  const marks = jp.station_marks(data.goals || [], c, jp.turns_in_place(c));
  return h("div", {class: "stay"}, jp.floor_map({grid: data.map, x: c.position_x_m, y: c.position_y_m, heading: c.heading_rad, speed: c.linear_speed_m_s, marks, label: "Map with the plan's path"}).element);
};
/** The map beside what is compared on it. */
jp.beside_map = (data, ...content) => { const map = jp.way_map(data); return map ? h("div", {class: "side"}, map, h("div", {}, content)) : h("div", {}, content); };
const saved_percent = (one) => 100 * (1 - one.optimum_J / one.energy_J);

/** A controller's settings on the plan's path: in their own time, and waiting until the plan's time. */
function draw_loss(data, loss) {
  const own = loss.own_time, rows = [["settings, their own time", own], ...(loss.plan_time ? [["settings, then waiting until the plan's time", loss.plan_time]] : [])];
  const motions = jp.overlaid_profiles(data.profiles || []);
  const list = (title, items) => (items || []).length ? h("details", {}, h("summary", {}, `${title}: ${items.length}`), h("ul", {}, items.map((one) => h("li", {}, one)))) : null;
  jp.page(jp.header(data.title || "Comparison", `${jp.against_text("These settings", own)} The plan: ${jp.cost_text(loss.plan)}.`, loss.broken_limit ? "exceeds a limit" : null, false),
    h("div", {class: "tiles"}, jp.tile("These settings", with_unit(own.energy_J, "J", 5), with_unit(own.duration_s, "s")), jp.tile("Optimal in their time", with_unit(own.optimum_J, "J", 5), `${percent(own.lost_percent, 2)} less`),
      jp.tile("The plan", with_unit(loss.plan.energy_J, "J", 5), with_unit(loss.plan.duration_s, "s"))),
    jp.beside_map(data, jp.section("Energy", jp.table(["same path", {n: "time s"}, {n: "energy J"}, {n: "least J in it"}, {n: "saving"}], [...rows.map(([name, one]) => [name, {n: number(one.duration_s)}, {n: number(one.energy_J, 6)}, {n: number(one.optimum_J, 6)}, {n: percent(one.lost_percent)}]),
      ["plan", {n: number(loss.plan.duration_s)}, {n: number(loss.plan.energy_J, 6)}, {n: ""}, {n: ""}]]), loss.plan_time ? null : h("p", {class: "soft"}, "The settings are later than the plan."), loss.broken_limit ? h("p", {}, `Exceeds a limit: ${loss.broken_limit}`) : null),
    motions, motions ? h("p", {class: "soft"}, "Each in its own time." + jp.dwell_text([loss.plan], data.profiles)) : null,
    jp.section("The file", h("p", {class: "soft"}, loss.of), list("Parameters read", loss.parameters), list("Not used", loss.unused), list("Not modelled", loss.not_modelled))));
}

jp.draw_compare = function (data) {
  if (data.compare.loss) return draw_loss(data, data.compare.loss);
  const listed = (data.compare.profiles || []), plan = listed[0] || {};
  const counted = listed.filter((one) => one.feasible !== false && is_number(one.energy_J)), others = counted.slice(1).sort((a, b) => saved_percent(a) - saved_percent(b));
  const over = jp.overlaid_profiles(data.profiles || []);
  const more = (name, optimum) => { const with_it = counted.filter((one) => is_number(one[name]) && is_number(one[optimum])); return jp.difference_rows(with_it.map((one) => ({label: jp.profile_name(one), value: one[name], base: one[optimum]})), "J"); };
  const tile = (what, one) => jp.tile(what, words(one.name), `${percent(saved_percent(one))} saved: ${with_unit(one.energy_J - one.optimum_J, "J", 3)} of ${with_unit(one.energy_J, "J", 5)}`);
  jp.page(jp.header(data.title || "Comparison", (others.length ? jp.against_text(`The best classic profile, ${jp.profile_name(others[0])}`, others[0]) + " " : "") + `The plan: ${jp.cost_text(plan)}.`, null, true),
    h("div", {class: "tiles"}, jp.tile("The plan", with_unit(plan.energy_J, "J", 5), with_unit(plan.duration_s, "s")), others.length ? [tile("Best classic profile", others[0]), others.length > 1 ? tile("Worst", others.at(-1)) : null] : null),
    h("p", {class: "soft"}, "Same path. A profile that is later than the plan is compared in its own time. Savings are relative to the profile's energy." + jp.dwell_text(listed, data.profiles || [])),
    jp.beside_map(data, jp.section("Energy", h("div", {class: "columns"}, h("div", {}, h("h3", {}, "Motion, without standby, and its excess over the least in the same time"), more("motion_energy_J", "optimum_motion_J")), h("div", {}, h("h3", {}, "At the battery, with standby, and its excess over the least in the same time"), more("energy_J", "optimum_J"))),
      jp.table(["profile", {n: "energy J"}, {n: "motion J"}, {n: "time s"}, {n: "least J in it"}, {n: "saving"}, "settings"], listed.map((one) => one.feasible === false
        ? [words(one.name), {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, "infeasible: " + (one.reason || "exceeds a limit")]
        : [jp.profile_name(one), {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.duration_s)}, {n: number(one.optimum_J, 6)}, {n: one === plan ? "" : percent(saved_percent(one))}, jp.settings_text(one.parameters)])))),
    over);
};

/** A curve through points by their slopes (cubic; slopes of at most three times the chord's keep it monotone); a slope that is not known is that of the neighbors. */
jp.curve_of = function (points, slope_of) {
  const kSteps = 16, at = (k) => points[k], secant = (k) => (at(k + 1).y - at(k).y) / (at(k + 1).x - at(k).x), last = points.length - 1, xs = [], ys = [];
  const between = (k) => (k === 0 ? secant(0) : k === last ? secant(last - 1) : 0.5 * (secant(k - 1) + secant(k)));
  const slope = points.map((one, k) => (last === 0 ? 0 : slope_of(one) ?? between(k)));
  for (let k = 0; k < last; ++k) {
    const width = at(k + 1).x - at(k).x, chord = secant(k), bounded = (value) => (value * chord <= 0 ? 0 : Math.sign(chord) * Math.min(Math.abs(value), 3 * Math.abs(chord)));
    const [from, to] = [bounded(slope[k]), bounded(slope[k + 1])];
    for (let n = 0; n < kSteps; ++n) {
      const u = n / kSteps, v = 1 - u;
      xs.push(at(k).x + u * width);
      ys.push(v * v * (1 + 2 * u) * at(k).y + u * u * (3 - 2 * u) * at(k + 1).y + u * v * width * (v * from - u * to));
    }
  }
  if (points.length) { xs.push(at(last).x); ys.push(at(last).y); }
  return {xs, ys};
};

jp.draw_front = function (data) {
  const points = (data.front.points || []).filter((one) => is_number(one.duration_s) && is_number(one.energy_J)).sort((a, b) => a.duration_s - b.duration_s);
  const others = (data.front.baselines || []).filter((one) => one.feasible !== false && is_number(one.energy_J));
  const span_s = points.length ? points[points.length - 1].duration_s - points[0].duration_s : 0;
  const near = others.filter((one) => points.length && one.duration_s <= points[points.length - 1].duration_s + span_s);  // much later ones are shown in the table only
  const names = [...new Set(near.map((one) => one.name))], sure = (data.front.confidence || {}).points || [];
  const x = [...new Set([...points, ...near, ...sure].map((one) => one.duration_s))].sort((a, b) => a - b);
  const find = (list, key) => x.map((t) => { const one = list.find((entry) => entry.duration_s === t); return one && is_number(one[key]) ? one[key] : null; });
  const cursor = jp.cursor(x.length, (row) => {
    const one = points.find((entry) => entry.duration_s === x[row]);
    const careful = sure.find((entry) => entry.duration_s === x[row]);
    const beside = near.filter((entry) => entry.duration_s === x[row]).sort((a, b) => a.energy_J - b.energy_J).map((entry) => ` · ${words(entry.name)} ${with_unit(entry.energy_J, "J", 5)}`);
    return with_unit(x[row], "s", 5) + (one ? ` · optimal ${with_unit(one.energy_J, "J", 5)}` + (is_number(one.price_of_time_W) ? ` · value of a second ${with_unit(one.price_of_time_W, "W")}` : "") : "") + (careful ? ` · with margins ${with_unit(careful.energy_J, "J", 5)}` : "") + beside.join("");
  });
  // The slope of the energy is the price of a second; standby adds the same to each second of both.
  const standby_W = (list) => (list.length > 1 ? (list.at(-1).energy_J - list.at(-1).motion_energy_J - list[0].energy_J + list[0].motion_energy_J) / (list.at(-1).duration_s - list[0].duration_s) : 0);
  const curve = (list, key, priced) => jp.curve_of(list.map((one) => ({x: one.duration_s, y: one[key], price: one.price_of_time_W})), (one) => (priced && is_number(one.price) ? -one.price - (key === "energy_J" ? 0 : standby_W(list)) : null));
  const series = (name, list, key, look, priced) => ({name, values: find(list, key), curve: curve(list, key, priced), ...look});
  const make = (title, key) => jp.plot({title, unit: "J", x: () => x, x_label: () => "duration, s", cursor, tall: true, fitted: true, series: [series("optimal", points, key, {color: "plan", points: 3}, true),
    ...(sure.length ? [series(`with margins for ${percent(100 * data.front.confidence.asked, 4)}`, sure, key, {color: "limit", points: 2}, true)] : []),
    ...names.map((name, k) => ({name: words(name), values: find(near.filter((one) => one.name === name), key), ...marks_of(k)}))]});
  const plots = [make("Energy at the battery, with standby", "energy_J")];
  if (points.some((one) => is_number(one.motion_energy_J))) plots.push(make("Motion energy, without standby", "motion_energy_J"));
  const beside = others.length ? jp.section("Classic profiles", jp.table(["same path, own time", {n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "least J in it"}, {n: "saving"}], others.map((one) => [jp.profile_name(one), {n: number(one.duration_s, 5)}, {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.optimum_J, 6)}, {n: percent(saved_percent(one), 3)}]))) : null;
  const least = points.reduce((best, one) => (one.energy_J < best.energy_J ? one : best), points[0]), fastest = points[0];
  const sentence = points.length === 1 ? `The fastest drive is the most economical one: ${jp.cost_text(least)}.` : points.length ? `The fastest drive: ${jp.cost_text(fastest)}. The most economical: ${jp.cost_text(least)} (${percent(100 * (1 - least.energy_J / fastest.energy_J), 2)} less).` : "No point.";
  jp.page(jp.header(data.title || "Energy against time", sentence, null, true),
    points.length ? h("div", {class: "tiles"}, jp.tile("Least energy", with_unit(least.energy_J, "J"), `at ${with_unit(least.duration_s, "s")}`), jp.tile("Fastest", with_unit(points[0].duration_s, "s"), with_unit(points[0].energy_J, "J")), jp.tile("Points", String(points.length))) : null,
    h("p", {class: "soft"}, `Each point is the least energy for its duration on ${points.some((one) => one.ways) ? "the paths of three plans: of least energy, of least time and between" : "the planned paths"}. The slope is the price of a second.` + (names.length ? " Marks are classic profiles in their own times; slider and pointer name them." : "")),
    jp.beside_map(data, jp.section("The front", cursor.element, h("div", {class: "plots"}, plots.map((plot) => plot.element)))),
    jp.section("Numbers", jp.table([{n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "value of a second, W"}, "status", ...(points.some((one) => one.ways) ? ["paths of"] : [])], points.map((one) => [{n: number(one.duration_s, 5)}, {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.price_of_time_W, 4)}, words(one.status || ""), ...(one.ways ? [words(one.ways)] : [])]))), beside);
};
