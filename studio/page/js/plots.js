/** Plots over time or distance with one cursor; a band under each shows which limit binds. */
import {h, sharp} from "studio/dom.js";
import {is_number, number, row_at, short, ticks, value_at} from "studio/numbers.js";
import {on, set_cursor, store} from "studio/store.js";
import {color, free_color, limit_color, on_theme} from "studio/theme.js";

const kLeft = 46, kRight = 8, kTop = 6, kBottom = 20, kBand = 6;
export const axis = {by: "time"};

/** Distance driven at each row, over all legs. */
export function distances(motion) {
  let before = 0, leg = 0, last = 0;
  return motion.arc_length_m.map((s, k) => {
    if (motion.leg[k] !== leg) { before += last; leg = motion.leg[k]; }
    last = s;
    return before + s;
  });
}
const abscissa = (motion) => (axis.by === "time" ? motion.time_s : distances(motion));

const kPlots = [
  {title: "Speed", unit: "m/s", series: [["linear_speed_m_s", "plan", ""]], limit: ["speed_m_s"]},
  {title: "Acceleration", unit: "m/s²", series: [["linear_acceleration_m_s2", "plan", ""]], step: true},
  {title: "Power", unit: "W", series: [["battery_power_W", "plan", ""]]},
  {title: "Wheel torque", unit: "N m", series: [["wheel_torque_left_Nm", "plan", "left"], ["wheel_torque_right_Nm", "second", "right"]]},
  {title: "Energy", unit: "J", series: [["energy_J", "plan", ""]]},
];

/** Lines of a plot: the plan's, those of plan A, those of the classic profiles that are shown. */
function lines_of(plot) {
  const lines = [];
  for (const classic of store.classics || []) if (classic.shown && classic.motion)
    for (const [column] of plot.series.slice(0, 1)) lines.push({motion: classic.motion, column, stroke: color(classic.color), dash: [5, 3], width: 1.3});
  if (store.kept) for (const [column] of plot.series) lines.push({motion: store.kept.answer.motion, column, stroke: color("soft"), dash: [2, 3], width: 1.5});
  if (store.answer) for (const [column, name] of plot.series) lines.push({motion: store.answer.motion, column, stroke: color(name), width: 1.8});
  return lines;
}

function plot_of(plot) {
  const canvas = h("canvas", {role: "img", "aria-label": `${plot.title} in ${plot.unit}`});
  const now = h("span", {class: "now"});
  const names = plot.series.filter(([, , name]) => name).map(([, stroke, name]) => h("span", {class: "key"}, h("i", {style: `border-color: var(--${stroke})`}), name));
  const element = h("div", {class: "plot-block"}, h("div", {class: "plot-head"}, h("h3", {}, plot.title), h("span", {class: "soft"}, plot.unit), names, now), h("div", {class: "plot"}, canvas));
  let frame = null;

  function draw() {
    if (!canvas.isConnected || !canvas.parentElement.clientWidth || !store.answer) return;
    const {context, width, height} = sharp(canvas), m = store.answer.motion, xs = abscissa(m), lines = lines_of(plot);
    let low = 0, high = 0, end = xs.at(-1) || 1;
    for (const line of lines) {
      for (const value of line.motion[line.column]) if (is_number(value)) { low = Math.min(low, value); high = Math.max(high, value); }
      end = Math.max(end, abscissa(line.motion).at(-1));
    }
    const margin = 0.06 * (high - low) || 1;
    low -= low < 0 ? margin : 0; high += margin;
    const bottom = height - kBottom, X = (x) => kLeft + (width - kLeft - kRight) * x / end, Y = (y) => kTop + (bottom - kBand - kTop) * (high - y) / (high - low);
    frame = {X, end, width};
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif"; context.fillStyle = color("soft"); context.strokeStyle = color("grid"); context.lineWidth = 1;
    context.textAlign = "right"; context.textBaseline = "middle";
    for (const tick of ticks(low, high, height / 34)) { context.beginPath(); context.moveTo(kLeft, Y(tick)); context.lineTo(width - kRight, Y(tick)); context.stroke(); context.fillText(short(tick), kLeft - 5, Y(tick)); }
    context.textAlign = "center"; context.textBaseline = "top";
    for (const tick of ticks(0, end, width / 75)) context.fillText(short(tick), Math.min(X(tick), width - 16), bottom + 4);
    context.save(); context.beginPath(); context.rect(kLeft, 0, width - kLeft - kRight, height); context.clip();
    draw_band(context, m, xs, X, bottom);
    for (const line of lines) draw_line(context, line, X, Y, plot.step);
    const x = X(value_at(m.time_s, xs, store.cursor_s));
    context.setLineDash([]); context.strokeStyle = color("focus"); context.lineWidth = 1.5; context.beginPath(); context.moveTo(x, kTop); context.lineTo(x, bottom); context.stroke();
    context.restore();
  }
  const label = () => {
    if (!store.answer) return;
    const m = store.answer.motion;
    now.textContent = plot.series.map(([column]) => number(plot.step ? m[column][row_at(m.time_s, store.cursor_s)] : value_at(m.time_s, m[column], store.cursor_s), 4)).join(" · ") + "\u202f" + plot.unit;
  };
  const point = (event) => {
    if (!frame || !store.answer) return;
    const m = store.answer.motion, x = (event.clientX - canvas.getBoundingClientRect().left - kLeft) / (frame.width - kLeft - kRight) * frame.end;
    set_cursor(axis.by === "time" ? x : m.time_s[row_at(abscissa(m), x)]);
  };
  canvas.addEventListener("pointermove", point);
  canvas.addEventListener("pointerdown", point);
  return {element, draw() { draw(); label(); }};
}

function draw_band(context, m, xs, X, bottom) {
  for (let k = 0; k + 1 < xs.length; ++k) {
    context.fillStyle = m.limit[k] < 0 ? free_color() : limit_color(store.answer.limits[m.limit[k]]);
    context.fillRect(X(xs[k]), bottom - kBand, Math.max(0.7, X(xs[k + 1]) - X(xs[k]) + 0.4), kBand);
  }
}
function draw_line(context, line, X, Y, step) {
  const xs = abscissa(line.motion), ys = line.motion[line.column];
  context.strokeStyle = line.stroke; context.lineWidth = line.width; context.setLineDash(line.dash || []);
  context.beginPath();
  ys.forEach((y, k) => {
    if (!is_number(y)) return;
    context.lineTo(X(xs[k]), Y(y));
    if (step && k + 1 < xs.length) context.lineTo(X(xs[k + 1]), Y(y));
  });
  context.stroke();
}

/** The plots with the names of the limits that bind in this plan. */
export function plots_panel() {
  const plots = kPlots.map(plot_of), legend = h("p", {class: "legend"});
  const by = (name) => h("button", {type: "button", "aria-pressed": String(axis.by === name), onclick: (event) => {
    axis.by = name;
    for (const other of event.target.parentElement.querySelectorAll("[aria-pressed]")) other.setAttribute("aria-pressed", String(other === event.target));
    draw();
  }}, "Over " + name);
  const draw = () => { plots.forEach((plot) => plot.draw()); };
  const names = () => {
    if (!store.answer) return;
    const m = store.answer.motion, end = m.time_s.at(-1) || 1, share = {};
    for (let k = 0; k + 1 < m.time_s.length; ++k) if (m.limit[k] >= 0) share[store.answer.limits[m.limit[k]]] = (share[store.answer.limits[m.limit[k]]] || 0) + m.time_s[k + 1] - m.time_s[k];
    legend.replaceChildren("Active limit: ", ...Object.entries(share).sort((a, b) => b[1] - a[1]).map(([name, time_s]) =>
      h("span", {class: "key"}, h("i", {class: "box", style: `background:${limit_color(name)}`}), `${name.replace(/_/g, " ")} ${short(100 * time_s / end, 2)} %`)),
    h("span", {class: "key"}, h("i", {class: "box", style: `background:${free_color()}`}), "no limit binds"));
  };
  let queued = false;
  const later = (all) => { if (all) names(); if (queued) return; queued = true; requestAnimationFrame(() => { queued = false; draw(); }); };
  on("answer", () => later(true));
  on("view", () => later(true));
  on("cursor", () => later(false));
  on_theme(() => later(true));
  window.addEventListener("resize", () => later(false));
  return h("section", {class: "plots", "aria-label": "Plots of the motion"}, h("div", {class: "tools"}, h("div", {role: "group", "aria-label": "Axis"}, by("time"), by("distance"))), legend, plots.map((plot) => plot.element));
}
