/** `joulepath sweep`: the best design, the Pareto front, the effect of each parameter, the reasons why designs do not count. */
import {h, key} from "page/dom.js";
import {fraction, number, percent, short, ticks, with_unit, words} from "page/numbers.js";
import {jp} from "report/core.js";
import "report/bars.js";

/** Energy against duration: every design a dot, the Pareto front on top. */
jp.design_cloud = function (sweep) {
  const front = (sweep.pareto || []).map((one) => [one.duration_s, one.energy_J]);
  const dots = sweep.cloud || [];
  const all = [...front, ...dots];
  if (all.length < 2) return null;
  const [height, left, right, bottom, top] = [340, 78, 30, 44, 12];
  const width = Math.max(320, Math.min(900, document.documentElement.clientWidth - 48));
  const range = (k) => { const values = all.map((one) => one[k]); const low = Math.min(...values), high = Math.max(...values); const pad = 0.04 * (high - low || Math.abs(high) || 1); return [low - pad, high + pad]; };
  const [t, e] = [range(0), range(1)];
  const x = (value) => left + (width - left - right) * (value - t[0]) / (t[1] - t[0]);
  const y = (value) => height - bottom - (height - bottom - top) * (value - e[0]) / (e[1] - e[0]);
  const svg = (tag, attributes, text) => { const node = document.createElementNS("http://www.w3.org/2000/svg", tag); Object.entries(attributes).forEach(([key, value]) => node.setAttribute(key, value)); if (text) node.textContent = text; return node; };
  const picture = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${dots.length} designs, energy against duration; ${front.length} on the Pareto front`, style: `width:100%;max-width:${width}px;height:auto`});
  const text = (attributes, content) => svg("text", {"font-size": 13, fill: "var(--soft)", ...attributes}, content);
  for (const at of ticks(...e, 5)) picture.append(svg("line", {x1: left, x2: width - right, y1: y(at), y2: y(at), stroke: "var(--grid)"}), text({x: left - 8, y: y(at) + 4, "text-anchor": "end"}, short(at, 5)));
  for (const at of ticks(...t, width / 110)) picture.append(text({x: x(at), y: height - bottom + 18, "text-anchor": "middle"}, short(at, 5)));
  picture.append(text({x: (left + width) / 2, y: height - 6, "text-anchor": "middle"}, "duration of all missions, s"),
    text({x: 14, y: (height - bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${(height - bottom) / 2})`}, "energy, J"));
  dots.forEach(([time, energy, within]) => picture.append(svg("circle", {cx: x(time), cy: y(energy), r: 3, fill: within ? "var(--sixth)" : "none", stroke: within ? "none" : "var(--soft)", "fill-opacity": 0.7})));
  front.forEach(([time, energy]) => picture.append(svg("circle", {cx: x(time), cy: y(energy), r: 5, fill: "var(--second)"})));
  return h("div", {}, h("p", {class: "small"}, key("Pareto front", "var(--second)", "box"), key("within the constraints", "var(--sixth)", "box"), dots.some(([, , within]) => !within) ? key("outside", "var(--soft)", "box") : null), picture);
};

/** The effect of a parameter: the mean of each level, and its share of the variance. */
jp.sweep_effects = function (effects, unit) {
  const shares = jp.bar_rows(effects.main.map((one) => ({label: one.parameter, value: one.share_of_variance, text: fraction(one.share_of_variance)})), {most: 1});
  const means = effects.main.map((one) => {
    const values = one.levels.map((level) => level.mean), low = Math.min(...values), high = Math.max(...values);
    return h("div", {}, h("h3", {}, one.parameter), jp.table(["level", {n: `mean, ${unit}`}, {n: "against the best level"}, {n: "designs"}],
      one.levels.map((level) => [level.level, {n: number(level.mean, 6)}, {n: high === low ? "–" : level.mean === low ? "best" : "+" + percent(100 * (level.mean / low - 1), 3)}, {n: String(level.designs)}])));
  });
  const pairs = effects.interactions.filter((one) => one.share_of_variance > 1e-4).slice(0, 10);
  const alone = effects.main.length < 2 ? null : h("p", {class: "soft"}, "No two parameters have a joint effect beyond the sum of their own effects.");
  return [h("h3", {}, "Share of the variance"), shares,
    pairs.length ? jp.table(["joint effect, beyond the sum", {n: "share of the variance"}], pairs.map((one) => [one.parameters.join(" and "), {n: fraction(one.share_of_variance)}])) : alone,
    h("div", {class: "columns"}, means)];
};

jp.draw_sweep = function (data) {
  const sweep = data.sweep, names = (sweep.parameters || []).map((one) => one.name);
  const value = (one, name) => (typeof one.parameters[name] === "number" ? short(one.parameters[name], 6) : String(one.parameters[name]));
  const heads = [...names.map((name) => ({n: name})), {n: "energy J"}, {n: "motion J"}, {n: "time s"}];
  const row = (one) => [...names.map((name) => ({n: value(one, name)})), {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.duration_s, 5)}];
  const best = sweep.optimized && sweep.optimized.within_constraints ? sweep.optimized : sweep.best;
  const reasons = Object.entries(sweep.not_counted || {});
  jp.page(jp.header(data.title || "Sweep", `${short(sweep.designs, 9)} design${sweep.designs === 1 ? "" : "s"}`, best ? `${short(sweep.within_constraints, 9)} within the constraints` : "no design within the constraints", Boolean(best)),
    best ? h("div", {class: "tiles"}, jp.tile("Energy", with_unit(best.energy_J, "J"), best === sweep.optimized ? "best design, found by --optimize" : `best design: ${best.design}`), ...names.map((name) => jp.tile(name, value(best, name))), jp.tile("Time", with_unit(best.duration_s, "s"))) : null,
    h("div", {class: "notice aside"}, h("b", {}, "Held constant: "), (sweep.held_constant || []).join("; ") + "."),
    sweep.pareto && sweep.pareto.length ? jp.section("Designs", jp.design_cloud(sweep), jp.table(heads, sweep.pareto.slice(0, 30).map(row), sweep.pareto.length > 30 ? `The first 30 of ${sweep.pareto.length} on the Pareto front` : "Pareto front")) : null,
    sweep.planned > 1 ? jp.section("Effect of each parameter on the energy", jp.sweep_effects(sweep.effects.energy_J, "J")) : null,
    sweep.planned > 1 ? jp.section("Effect of each parameter on the time", jp.sweep_effects(sweep.effects.duration_s, "s")) : null,
    reasons.length ? jp.section("Not counted", jp.table(["reason", {n: "plans"}], reasons.map(([reason, count]) => [words(reason), {n: String(count)}]))) : null);
};

jp.start(jp.draw_sweep);
