/* `joulepath compare`: profiles of one path overlaid. `joulepath front`: energy against time. */

const kSeriesColors = ["plan", "second", "third", "fourth", "fifth", "sixth"];
const kDashes = [null, [6, 3], [2, 2], [9, 3, 2, 3], [12, 4], [4, 4]];

/** A profile's name, with its delay in seconds after the plan or point. */
jp.profile_name = (one) => jp.words(one.name) + (one.later_s ? `, ${jp.number(one.later_s, 2)} s later` : "");

/** Profiles {name, columns} over time or over distance: speed, power, energy. */
jp.overlaid_profiles = function (profiles) {
  const drawn = profiles.filter((one) => one.columns && one.columns.time_s && one.columns.time_s.length);
  if (!drawn.length) return null;
  const all = {time: drawn.map((one) => one.columns.time_s), distance: drawn.map((one) => jp.distance(one.columns))};
  const grid_of = (by) => {
    const end = all[by].reduce((most, axis) => Math.max(most, axis[axis.length - 1]), 0);
    return Array.from({length: 1200}, (_, k) => end * k / 1199);
  };
  const holder = jp.h("div", {});
  let plots = [];
  const show = (by) => {
    const x = grid_of(by);
    const cursor = jp.cursor(x.length, (row) => (by === "time" ? `t ${jp.number(x[row])} s` : `${jp.number(x[row])} m`));
    const make = (title, unit, column) => {
      const series = drawn.map((one, k) => one.columns[column] && {name: jp.words(one.name), values: jp.sample(all[by][k], one.columns[column], x), color: kSeriesColors[k % 6], dash: kDashes[Math.floor(k / 6) % 6] || kDashes[k % 6]}).filter(Boolean);
      return series.length ? jp.plot({title, unit, series, x, cursor}) : null;
    };
    plots = [make("Speed", "m/s", "linear_speed_m_s"), make("Acceleration", "m/s²", "linear_acceleration_m_s2"), make("Power", "W", "battery_power_W"), make("Energy", "J", "energy_J")].filter(Boolean);
    plots[plots.length - 1].label(by === "time" ? "time, s" : "distance, m");
    holder.replaceChildren(cursor.element, ...plots.map((plot) => plot.element));
    plots.forEach((plot) => plot.draw());
    buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.by === by)));
  };
  const buttons = ["time", "distance"].map((by) => jp.h("button", {type: "button", "data-by": by, onclick: () => show(by)}, "Over " + by));
  const redraw = () => plots.forEach((plot) => plot.redraw());
  const section = jp.section("Profiles", jp.h("div", {class: "bar-tools"}, buttons), holder);
  section.classList.add("long");
  return {section, ready() { show("time"); jp.redraws.push(redraw); window.addEventListener("resize", redraw); }};
};

jp.draw_compare = function (data) {
  const listed = (data.compare.profiles || []);
  const counted = listed.filter((one) => one.feasible !== false && jp.is_number(one.energy_J));
  const least = counted.reduce((least, one) => Math.min(least, one.energy_J), Infinity);
  const over = jp.overlaid_profiles(data.profiles || []);
  const bars = (key) => jp.bar_rows(counted.filter((one) => jp.is_number(one[key])).map((one, k) => ({label: jp.profile_name(one), value: one[key], text: jp.with_unit(one[key], "J"), color: k ? "var(--second)" : "var(--plan)"})));
  jp.page(jp.header(data.title || "Comparison", data.subtitle || "Same path, same time.", null, true),
    jp.section("Energy", jp.h("div", {class: "columns"}, jp.h("div", {}, jp.h("h3", {}, "Motion, without standby"), bars("motion_energy_J")), jp.h("div", {}, jp.h("h3", {}, "At the battery, with standby"), bars("energy_J"))),
      jp.table(["profile", {n: "energy J"}, {n: "motion J"}, {n: "time s"}, {n: "more than the least"}, "settings"], listed.map((one) => one.feasible === false
        ? [jp.words(one.name), {n: "–"}, {n: "–"}, {n: "–"}, {n: "–"}, "infeasible: " + (one.reason || "exceeds a limit")]
        : [jp.profile_name(one), {n: jp.number(one.energy_J, 6)}, {n: jp.number(one.motion_energy_J, 6)}, {n: jp.number(one.duration_s)}, {n: jp.percent(100 * (one.energy_J / least - 1), 3)}, jp.settings_text(one.parameters)]))),
    over ? over.section : null);
  if (over) over.ready();
};

jp.draw_front = function (data) {
  const points = (data.front.points || []).filter((one) => jp.is_number(one.duration_s) && jp.is_number(one.energy_J)).sort((a, b) => a.duration_s - b.duration_s);
  const others = (data.front.baselines || []).filter((one) => one.feasible !== false && jp.is_number(one.energy_J));
  const span_s = points.length ? points[points.length - 1].duration_s - points[0].duration_s : 0;
  const near = others.filter((one) => points.length && one.duration_s <= points[points.length - 1].duration_s + span_s);  // much later ones are shown in the table only
  const names = [...new Set(near.map((one) => one.name))];
  const x = [...new Set([...points, ...near].map((one) => one.duration_s))].sort((a, b) => a - b);
  const find = (list, key) => x.map((t) => { const one = list.find((entry) => entry.duration_s === t); return one && jp.is_number(one[key]) ? one[key] : null; });
  const cursor = jp.cursor(x.length, (row) => {
    const one = points.find((entry) => entry.duration_s === x[row]);
    return `${jp.number(x[row])} s` + (one ? ` · ${jp.with_unit(one.energy_J, "J")}` + (jp.is_number(one.price_of_time_W) ? ` · value of a second ${jp.with_unit(one.price_of_time_W, "W")}` : "") : "");
  });
  const make = (title, key) => jp.plot({title, unit: "J", x, x_label: "duration, s", cursor, tall: true, series: [{name: "optimal", values: find(points, key), color: "plan", points: 3},
    ...names.map((name, k) => ({name: jp.words(name), values: find(near.filter((one) => one.name === name), key), color: kSeriesColors[1 + k % 5], dash: kDashes[1 + k % 5], points: 2}))]});
  const plots = [make("Energy at the battery, with standby", "energy_J")];
  if (points.some((one) => jp.is_number(one.motion_energy_J))) plots.push(make("Motion energy, without standby", "motion_energy_J"));
  const over = jp.overlaid_profiles(data.profiles || []);
  const beside = others.length ? jp.section("Classic profiles", jp.table(["same path, same time", {n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "more than the optimum"}], others.map((one) => [jp.profile_name(one), {n: jp.number(one.duration_s, 5)}, {n: jp.number(one.energy_J, 6)}, {n: jp.number(one.motion_energy_J, 6)}, {n: jp.percent(100 * (one.energy_J / one.optimum_J - 1), 3)}]))) : null;
  const least = points.reduce((best, one) => (one.energy_J < best.energy_J ? one : best), points[0]);
  jp.page(jp.header(data.title || "Energy against time", data.subtitle || "Each point is the least energy for its duration. The slope is the price of a second.", null, true),
    points.length ? jp.h("div", {class: "tiles"}, jp.tile("Least energy", jp.with_unit(least.energy_J, "J"), `at ${jp.with_unit(least.duration_s, "s")}`), jp.tile("Fastest", jp.with_unit(points[0].duration_s, "s"), jp.with_unit(points[0].energy_J, "J")), jp.tile("Points", String(points.length))) : null,
    jp.section("The front", cursor.element, plots.map((plot) => plot.element)), over ? over.section : null,
    jp.section("Numbers", jp.table([{n: "duration s"}, {n: "energy J"}, {n: "motion J"}, {n: "value of a second, W"}, "status"], points.map((one) => [{n: jp.number(one.duration_s, 5)}, {n: jp.number(one.energy_J, 6)}, {n: jp.number(one.motion_energy_J, 6)}, {n: jp.number(one.price_of_time_W, 4)}, jp.words(one.status || "")]))), beside);
  jp.draw_plots(plots);
  if (over) over.ready();
};
