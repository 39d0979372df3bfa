/** `joulepath compare`: profiles of one path overlaid. `joulepath front`: energy against time. */
import {h} from "page/dom.js";
import {is_number, number, percent, with_unit, words} from "page/numbers.js";
import {jp} from "report/core.js";
import "report/bars.js";
import "report/plots.js";

const kSeriesColors = ["plan", "second", "third", "fourth", "fifth", "sixth"];
const kSteps = 1200;  // places of the cursor
const kDashes = [null, [6, 3], [2, 2], [9, 3, 2, 3], [12, 4], [4, 4]];
/** The look of the k-th line; lines of the same color have different dashes. */
const look_of = (k) => ({color: kSeriesColors[k % 6], dash: kDashes[(k + Math.floor(k / 6)) % 6]});
/** The same beside a line of the first look. */
const look_beside = (k) => ({color: kSeriesColors[1 + k % 5], dash: kDashes[1 + (k + Math.floor(k / 5)) % 5]});

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

jp.draw_compare = function (data) {
  const listed = (data.compare.profiles || []);
  const counted = listed.filter((one) => one.feasible !== false && is_number(one.energy_J));
  const over = jp.overlaid_profiles(data.profiles || []);
  const more = (name, optimum) => { const plan = (listed[0] || {})[name], with_it = counted.filter((one) => is_number(one[name]) && is_number(one[optimum])); return jp.difference_rows(with_it.map((one) => ({label: jp.profile_name(one), value: plan + one[name] - one[optimum]})), plan, "J"); };
  jp.page(jp.header(data.title || "Comparison", (data.subtitle || "Same path. A profile that is later than the plan is compared in its own time.") + jp.dwell_text(listed, data.profiles || []), null, true),
    jp.section("Energy", h("div", {class: "columns"}, h("div", {}, h("h3", {}, "Motion, without standby: more than the least in the same time"), more("motion_energy_J", "optimum_motion_J")), h("div", {}, h("h3", {}, "At the battery, with standby: more than the least in the same time"), more("energy_J", "optimum_J"))),
      jp.table(["profile", {n: "energy J"}, {n: "motion J"}, {n: "time s"}, {n: "more than the least in it"}, "settings"], listed.map((one) => one.feasible === false
        ? [words(one.name), {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, "infeasible: " + (one.reason || "exceeds a limit")]
        : [jp.profile_name(one), {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.duration_s)}, {n: percent(100 * (one.energy_J / one.optimum_J - 1), 3)}, jp.settings_text(one.parameters)]))),
    over);
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
    return `${number(x[row])} s` + (one ? ` · ${with_unit(one.energy_J, "J")}` + (is_number(one.price_of_time_W) ? ` · value of a second ${with_unit(one.price_of_time_W, "W")}` : "") : "");
  });
  const make = (title, key) => jp.plot({title, unit: "J", x: () => x, x_label: () => "duration, s", cursor, tall: true, fitted: true, series: [{name: "optimal", values: find(points, key), color: "plan", points: 3},
    ...(sure.length ? [{name: `with margins for ${percent(100 * data.front.confidence.asked, 4)}`, values: find(sure, key), color: "limit", points: 2}] : []),
    ...names.map((name, k) => ({name: words(name), values: find(near.filter((one) => one.name === name), key), ...look_beside(k), points: 2}))]});
  const plots = [make("Energy at the battery, with standby", "energy_J")];
  if (points.some((one) => is_number(one.motion_energy_J))) plots.push(make("Motion energy, without standby", "motion_energy_J"));
  const over = jp.overlaid_profiles(data.profiles || []);
  const beside = others.length ? jp.section("Classic profiles", jp.table(["same path, own time", {n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "more than the optimum"}], others.map((one) => [jp.profile_name(one), {n: number(one.duration_s, 5)}, {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: percent(100 * (one.energy_J / one.optimum_J - 1), 3)}]))) : null;
  const least = points.reduce((best, one) => (one.energy_J < best.energy_J ? one : best), points[0]);
  jp.page(jp.header(data.title || "Energy against time", data.subtitle || "Each point is the least energy for its duration on the planned paths. The slope is the price of a second.", null, true),
    points.length ? h("div", {class: "tiles"}, jp.tile("Least energy", with_unit(least.energy_J, "J"), `at ${with_unit(least.duration_s, "s")}`), jp.tile("Fastest", with_unit(points[0].duration_s, "s"), with_unit(points[0].energy_J, "J")), jp.tile("Points", String(points.length))) : null,
    jp.section("The front", cursor.element, h("div", {class: "plots"}, plots.map((plot) => plot.element))), over,
    jp.section("Numbers", jp.table([{n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "value of a second, W"}, "status"], points.map((one) => [{n: number(one.duration_s, 5)}, {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.price_of_time_W, 4)}, words(one.status || "")]))), beside);
};
