/** `joulepath sweep`: the best design, the Pareto front, the effect of each parameter, the reasons why designs do not count. */
import {h, key} from "page/dom.js";
import {fraction, number, percent, short, split_key, ticks, with_unit, words} from "page/numbers.js";
import {ramp, ramp_css} from "page/theme.js";
import {jp} from "report/core.js";
import "report/bars.js";
import "report/plots.js";

const value_text = (value) => (typeof value === "number" ? short(value, 6) : String(value));
/** The unit of a parameter: that of its name, else of its key. */
const unit_of = (parameter) => split_key(parameter.name).unit || split_key(parameter.key || "").unit;
const parameter_text = (parameter, value) => [split_key(parameter.name).words, value_text(value), unit_of(parameter)].filter(Boolean).join(" ");
const design_text = (sweep, one) => sweep.parameters.map((parameter) => parameter_text(parameter, one.parameters[parameter.name])).join(", ");

const svg = (tag, attributes, text) => { const node = document.createElementNS("http://www.w3.org/2000/svg", tag); Object.entries(attributes).forEach(([key, value]) => node.setAttribute(key, value)); if (text) node.textContent = text; return node; };
const svg_text = (attributes, content) => svg("text", {"font-size": 13, fill: "var(--soft)", ...attributes}, content);

/** Designs as {duration_s, energy_J, within, values}, in the order of their durations. */
function designs_of(sweep) {
  const typed = (value) => (isFinite(Number(value)) ? Number(value) : value);
  return (sweep.cloud || []).map(([duration_s, energy_J, within, values]) => ({duration_s, energy_J, within, values: values.map(typed)})).sort((a, b) => a.duration_s - b.duration_s || a.energy_J - b.energy_J);
}
const dot_text = (sweep, one) => `${sweep.parameters.map((parameter, k) => parameter_text(parameter, one.values[k])).join(", ")}: ${with_unit(one.energy_J, "J", 6)}, ${with_unit(one.duration_s, "s", 5)}` + (one.within ? "" : ", outside the constraints");

/** The cloud in the colors of one parameter, which a list chooses. A slider for keys, or the pointer, names a dot. */
jp.design_cloud = function (sweep) {
  const designs = designs_of(sweep), front = sweep.pareto || [];
  if (designs.length + front.length < 2) return null;
  const box = h("div"), chosen = h("select", {id: "color-by", onchange: () => draw()}, sweep.parameters.map((one, k) => h("option", {value: k}, split_key(one.name).words)));
  const named = jp.cursor(designs.length, (row) => dot_text(sweep, designs[row]));
  named.element.querySelector("input").setAttribute("aria-label", "Design, in the order of durations");
  named.element.querySelector(".readout").textContent = "Move over the dots, or use the slider and its arrow keys: each dot is a design.";
  let point = () => {};
  const draw = () => { const drawn = cloud_picture(sweep, designs, front, Number(chosen.value), named); point = drawn.point; point(named.row); box.replaceChildren(drawn.element); };
  named.follow((row) => point(row));
  draw();
  jp.redraws.push(draw);
  return h("div", {}, h("p", {class: "small"}, h("label", {for: "color-by"}, "Color by "), chosen), designs.length ? named.element : null, box);
};

/** The levels of a parameter in order, and the color of each. */
function scale_of(designs, p) {
  const levels = [...new Set(designs.map((one) => one.values[p]))].sort((a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a) < String(b) ? -1 : 1));
  const numeric = levels.every((value) => typeof value === "number") && levels.at(-1) > levels[0];
  const place = (value) => (numeric ? (value - levels[0]) / (levels.at(-1) - levels[0]) : levels.length > 1 ? levels.indexOf(value) / (levels.length - 1) : 0);
  return {levels, numeric, color_of: (value) => ramp(place(value))};
}
function cloud_legend({levels, numeric, color_of}, parameter, has_hollow) {
  const shades = numeric && levels.length > 6 ? h("span", {class: "scale", style: "display:inline-flex;margin:0 10px 0 0"}, parameter_text(parameter, levels[0]), h("span", {class: "ramp", style: `background:${ramp_css()}`}), parameter_text(parameter, levels.at(-1)))
    : levels.map((value) => key(parameter_text(parameter, value), color_of(value), "box"));
  const circle = (px, line, text) => h("span", {class: "key"}, h("i", {style: `width:${px}px;height:${px}px;border:${line};border-radius:50%`}), text);
  return h("p", {class: "small"}, circle(14, "2px solid var(--second)", "ring: Pareto front"), shades, has_hollow ? circle(11, "3px solid var(--soft)", "hollow: outside the constraints") : null);
}

/** Energy against duration: every design a dot, the Pareto front ringed. {element, point(row)}: point shows which dot is named. */
function cloud_picture(sweep, designs, front, p, named) {
  const parameter = sweep.parameters[p], scale = scale_of(designs, p);
  const width = Math.max(320, Math.min(1400, document.documentElement.clientWidth - 48)), height = Math.max(340, Math.min(480, 0.36 * width));
  const [left, right, bottom, top] = [78, 30, 44, 12];
  const range = (name) => { const values = [...front, ...designs].map((one) => one[name]); const low = values.reduce((a, b) => Math.min(a, b)), high = values.reduce((a, b) => Math.max(a, b)); const pad = 0.06 * (high - low || Math.abs(high) || 1); return [low - pad, high + pad]; };
  const [t, e] = [range("duration_s"), range("energy_J")];
  const place = (one) => [left + (width - left - right) * (one.duration_s - t[0]) / (t[1] - t[0]), height - bottom - (height - bottom - top) * (one.energy_J - e[0]) / (e[1] - e[0])];
  const picture = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${designs.length} designs, energy against duration; ${front.length} on the Pareto front`, style: `display:block;width:100%;max-width:${width}px;height:auto;touch-action:pan-y`});
  for (const at of ticks(...e, 5)) { const [, y] = place({duration_s: t[0], energy_J: at}); picture.append(svg("line", {x1: left, x2: width - right, y1: y, y2: y, stroke: "var(--grid)"}), svg_text({x: left - 8, y: y + 4, "text-anchor": "end"}, short(at, 5))); }
  for (const at of ticks(...t, width / 110)) picture.append(svg_text({x: place({duration_s: at, energy_J: e[0]})[0], y: height - bottom + 18, "text-anchor": "middle"}, short(at, 5)));
  picture.append(svg_text({x: (left + width) / 2, y: height - 6, "text-anchor": "middle"}, "duration of all missions, s"),
    svg_text({x: 14, y: (height - bottom) / 2, "text-anchor": "middle", transform: `rotate(-90 14 ${(height - bottom) / 2})`}, "energy, J"));
  front.forEach((one) => { const [cx, cy] = place(one); picture.append(svg("circle", {cx, cy, r: 9, fill: "none", stroke: "var(--second)", "stroke-width": 2})); });
  const places = designs.map(place);
  designs.forEach((one, k) => {
    const [cx, cy] = places[k], shade = scale.color_of(one.values[p]);
    if (!one.within) picture.append(svg("circle", {cx, cy, r: 4.5, fill: "none", stroke: "var(--soft)", "stroke-width": 4}));  // edges that stand out of the ground in every shade
    const dot = svg("circle", {cx, cy, r: one.within ? 5 : 4.5, fill: one.within ? shade : "none", stroke: one.within ? "var(--soft)" : shade, "stroke-width": one.within ? 1 : 2.2});
    dot.append(svg("title", {}, dot_text(sweep, one)));
    picture.append(dot);
  });
  front_labels(picture, front, places, place, [left, width], (one) => [value_text(one.parameters[parameter.name]), unit_of(parameter)].filter(Boolean).join("\u202f"));
  const ring = svg("circle", {r: 12, fill: "none", stroke: "var(--ink)", "stroke-width": 3, visibility: "hidden", class: "named"});
  picture.append(ring);
  const point = (row) => { if (row >= 0) { ring.setAttribute("cx", places[row][0]); ring.setAttribute("cy", places[row][1]); ring.setAttribute("visibility", "visible"); } };
  const at_pointer = (event) => {
    const frame = picture.getBoundingClientRect(), zoom = width / frame.width, x = zoom * (event.clientX - frame.left), y = zoom * (event.clientY - frame.top);
    const far = ([px, py]) => Math.hypot(px - x, py - y), nearest = places.reduce((best, one, k) => (best < 0 || far(one) < far(places[best]) ? k : best), -1);
    if (nearest >= 0 && far(places[nearest]) < 30) named.set(nearest);
  };
  picture.addEventListener("pointermove", at_pointer);
  picture.addEventListener("pointerdown", at_pointer);
  return {element: h("div", {}, cloud_legend(scale, parameter, designs.some((one) => !one.within)), picture), point};
}

/** The chosen parameter's value beside each design of the front, where no dot and no other label is; else none. */
function front_labels(picture, front, places, place, [least, most], words_of) {
  const around = (r) => ([x, y]) => [x - r, y - r, x + r, y + r], boxes = [...places.map(around(7)), ...front.map(place).map(around(10))];
  for (const one of front) {
    const [x, y] = place(one), content = words_of(one), wide = 7.5 * content.length;
    const sides = [[x + 13, y + 4, "start", x + 12], [x - 13, y + 4, "end", x - 12 - wide], [x, y + 24, "middle", x - wide / 2], [x, y - 14, "middle", x - wide / 2]];
    for (const [at_x, at_y, anchor, from] of sides) {
      const box = [from, at_y - 12, from + wide, at_y + 3];
      if (box[0] < least || box[2] > most || boxes.some(([x0, y0, x1, y1]) => box[0] < x1 && x0 < box[2] && box[1] < y1 && y0 < box[3])) continue;
      boxes.push(box);
      picture.append(svg_text({x: at_x, y: at_y, "text-anchor": anchor}, content));
      break;
    }
  }
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
