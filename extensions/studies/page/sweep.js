/** `joulepath sweep`: the best design, the Pareto front, the effect of each parameter, the reasons why designs do not count. */
import {h, key} from "page/dom.js";
import {fraction, number, percent, short, split_key, ticks, with_unit, words} from "page/numbers.js";
import {ramp} from "page/theme.js";
import {jp} from "report/core.js";
import "report/bars.js";

const value_text = (value) => (typeof value === "number" ? short(value, 6) : String(value));
/** The unit of a parameter: that of its name, else of its key. */
const unit_of = (parameter) => split_key(parameter.name).unit || split_key(parameter.key || "").unit;
const parameter_text = (parameter, value) => [split_key(parameter.name).words, value_text(value), unit_of(parameter)].filter(Boolean).join(" ");
const design_text = (sweep, one) => sweep.parameters.map((parameter) => parameter_text(parameter, one.parameters[parameter.name])).join(", ");

/** The cloud in the colors of one parameter, which a list chooses. */
jp.design_cloud = function (sweep) {
  const box = h("div"), chosen = h("select", {id: "color-by", onchange: () => draw()}, sweep.parameters.map((one, k) => h("option", {value: k}, split_key(one.name).words)));
  const draw = () => { const picture = cloud_picture(sweep, Number(chosen.value)); if (picture) box.replaceChildren(picture); };
  draw();
  jp.redraws.push(draw);
  return h("div", {}, h("p", {class: "small"}, h("label", {for: "color-by"}, "Color by "), chosen), box);
};

/** Energy against duration: every design a dot, the Pareto front on top. */
function cloud_picture(sweep, p) {
  const front = (sweep.pareto || []).map((one) => [one.duration_s, one.energy_J]);
  const typed = (value) => (isFinite(Number(value)) ? Number(value) : value);
  const dots = (sweep.cloud || []).map(([time, energy, within, values]) => [time, energy, within, values.map(typed)]), parameter = sweep.parameters[p];
  const levels = [...new Set(dots.map((one) => one[3][p]))].sort((a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a) < String(b) ? -1 : 1));
  const place = (value) => (typeof value === "number" && levels.at(-1) > levels[0] ? (value - levels[0]) / (levels.at(-1) - levels[0]) : levels.length > 1 ? levels.indexOf(value) / (levels.length - 1) : 0), color_of = (value) => ramp(place(value));
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
  front.forEach(([time, energy]) => picture.append(svg("circle", {cx: x(time), cy: y(energy), r: 8, fill: "none", stroke: "var(--second)", "stroke-width": 2})));
  dots.forEach(([time, energy, within, values]) => {
    const dot = svg("circle", {cx: x(time), cy: y(energy), r: 4, fill: within ? color_of(values[p]) : "none", stroke: within ? "none" : color_of(values[p])});
    dot.append(svg("title", {}, `${sweep.parameters.map((one, k) => parameter_text(one, values[k])).join(", ")}: ${with_unit(energy, "J", 6)}, ${with_unit(time, "s", 5)}`));
    picture.append(dot);
  });
  const taken = [];  // a label that would lie on another one is left out
  for (const one of sweep.pareto || []) {
    const at = [x(one.duration_s), y(one.energy_J)], words_here = value_text(one.parameters[parameter.name]);
    if (taken.some(([px, py]) => Math.abs(px - at[0]) < 60 && Math.abs(py - at[1]) < 16)) continue;
    taken.push(at);
    picture.append(text({x: at[0] + (at[0] > width / 2 ? -11 : 11), y: at[1] + 4, "text-anchor": at[0] > width / 2 ? "end" : "start"}, words_here));
  }
  const shown = levels.length > 6 ? [levels[0], levels.at(-1)] : levels;
  return h("div", {}, h("p", {class: "small"}, key("ring: Pareto front", "var(--second)", "box"), shown.map((value) => key(parameter_text(parameter, value), color_of(value), "box")), dots.some(([, , within]) => !within) ? h("span", {class: "soft"}, "hollow: outside the constraints") : null), picture);
}

/** The effect of a parameter: the mean of each level, and its share of the variance. */
jp.sweep_effects = function (sweep, effects, unit) {
  const named = (name) => { const parameter = sweep.parameters.find((one) => one.name === name) || {name}; return [split_key(name).words, unit_of(parameter)].filter(Boolean).join(", "); };
  const shares = jp.bar_rows(effects.main.map((one) => ({label: named(one.parameter), value: one.share_of_variance, text: fraction(one.share_of_variance)})), {most: 1});
  const means = effects.main.map((one) => {
    const values = one.levels.map((level) => level.mean), low = Math.min(...values), high = Math.max(...values);
    return h("div", {}, h("h3", {}, named(one.parameter)), jp.table(["level", {n: `mean, ${unit}`}, {n: "the best level takes less"}, {n: "designs"}],
      one.levels.map((level) => [level.level, {n: number(level.mean, 6)}, {n: high === low ? "–" : level.mean === low ? "best" : percent(100 * (1 - low / level.mean), 3)}, {n: String(level.designs)}])));
  });
  const pairs = effects.interactions.filter((one) => one.share_of_variance > 1e-4).slice(0, 10);
  const alone = effects.main.length < 2 ? null : h("p", {class: "soft"}, "No two parameters have a joint effect beyond the sum of their own effects.");
  return [h("h3", {}, "Share of the variance"), shares,
    pairs.length ? jp.table(["joint effect, beyond the sum", {n: "share of the variance"}], pairs.map((one) => [one.parameters.map(named).join(" and "), {n: fraction(one.share_of_variance)}])) : alone,
    h("div", {class: "columns"}, means)];
};

jp.draw_sweep = function (data) {
  const sweep = data.sweep, parameters = sweep.parameters || [];
  const heads = [...parameters.map((one) => ({n: [split_key(one.name).words, unit_of(one)].filter(Boolean).join(" ")})), {n: "energy J"}, {n: "motion J"}, {n: "time s"}];
  const row = (one) => [...parameters.map(({name}) => ({n: value_text(one.parameters[name])})), {n: number(one.energy_J, 6)}, {n: number(one.motion_energy_J, 6)}, {n: number(one.duration_s, 5)}];
  const best = sweep.optimized && sweep.optimized.within_constraints ? sweep.optimized : sweep.best;
  const reasons = Object.entries(sweep.not_counted || {});
  const energies = (sweep.cloud || []).map((one) => one[1]), most_J = energies.reduce((a, b) => Math.max(a, b), 0), many = `${short(sweep.designs, 9)} design${sweep.designs === 1 ? "" : "s"}`;
  const sentence = best ? `The best of ${many}, ${design_text(sweep, best)}: ${with_unit(best.duration_s, "s", 5)}, ${with_unit(best.energy_J, "J", 6)}` + (most_J > best.energy_J ? `, ${percent(100 * (1 - best.energy_J / most_J), 2)} less than the costliest.` : ".") : `None of ${many} keeps the constraints.`;
  jp.page(jp.header(data.title || "Sweep", sentence, best ? `${short(sweep.within_constraints, 9)} within the constraints` : "no design within the constraints", Boolean(best)),
    best ? h("div", {class: "tiles"}, jp.tile("Energy", with_unit(best.energy_J, "J"), best === sweep.optimized ? "best design, found by --optimize" : `best design: ${best.design}`), ...parameters.map((one) => jp.tile(split_key(one.name).words, [value_text(best.parameters[one.name]), unit_of(one)].filter(Boolean).join("\u202f"))), jp.tile("Time", with_unit(best.duration_s, "s"))) : null,
    h("div", {class: "notice aside"}, h("b", {}, "Held constant: "), (sweep.held_constant || []).join("; ") + "."),
    sweep.pareto && sweep.pareto.length ? jp.section("Designs", jp.design_cloud(sweep), jp.table(heads, sweep.pareto.slice(0, 30).map(row), sweep.pareto.length > 30 ? `The first 30 of ${sweep.pareto.length} on the Pareto front` : "Pareto front")) : null,
    sweep.planned > 1 ? jp.section("Effect of each parameter on the energy", jp.sweep_effects(sweep, sweep.effects.energy_J, "J")) : null,
    sweep.planned > 1 ? jp.section("Effect of each parameter on the time", jp.sweep_effects(sweep, sweep.effects.duration_s, "s")) : null,
    reasons.length ? jp.section("Not counted", jp.table(["reason", {n: "plans"}], reasons.map(([reason, count]) => [words(reason), {n: String(count)}]))) : null);
};

jp.start(jp.draw_sweep);
