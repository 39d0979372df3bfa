/** Plots over time or distance with one cursor; a strip under each shows which limit binds. */
import {button, h, key} from "page/dom.js";
import {number, row_at, short, value_at, words} from "page/numbers.js";
import {plot} from "page/plot.js";
import {color, free_color, limit_color, on_theme} from "page/theme.js";
import {ask} from "studio/answers.js";
import {on, set_cursor, store} from "studio/store.js";

const axis = {by: "time", span: null};

/** Distance driven at each row, over all legs. */
function distances(motion) {
  let before = 0, leg = 0, last = 0;
  return motion.arc_length_m.map((s, k) => {
    if (motion.leg[k] !== leg) { before += last; leg = motion.leg[k]; }
    last = s;
    return before + s;
  });
}
const abscissa = (motion) => (axis.by === "time" ? motion.time_s : distances(motion));
const color_at = (motion) => (k) => (motion.limit[k] < 0 ? free_color() : limit_color(store.answer.limits[motion.limit[k]]));

const kPlots = [
  {title: "Speed", unit: "m/s", series: [["linear_speed_m_s", "plan", ""]]},
  {title: "Acceleration", unit: "m/s²", series: [["linear_acceleration_m_s2", "plan", ""]], step: true},
  {title: "Power", unit: "W", series: [["battery_power_W", "plan", ""]]},
  {title: "Wheel torque", unit: "N m", series: [["wheel_torque_left_Nm", "plan", "left"], ["wheel_torque_right_Nm", "second", "right"]]},
  {title: "Energy", unit: "J", series: [["energy_J", "plan", ""]]},
];

/** Lines of a plot: the plan's, those of plan A, those of the classic profiles that are shown. */
function lines_of({series, step}) {
  const line = (motion, column, stroke, look) => ({xs: abscissa(motion), ys: motion[column], stroke, step, ...look});
  const shown = (store.classics || []).filter((classic) => classic.shown && classic.motion);
  return [...shown.map((classic) => line(classic.motion, series[0][0], color(classic.color), {dash: classic.dash, width: 1.3})),
    ...(store.kept ? series.map(([column]) => line(store.kept.answer.motion, column, color("soft"), {dash: [2, 3], width: 1.5})) : []),
    ...series.map(([column, name]) => line(store.answer.motion, column, color(name), {width: 1.8}))];
}

/** Intervals of 95 % by column, of the present answer; null: not asked for, or not known yet. */
const sure = {shown: false, bands: null};

/** The interval of a plot's quantity; over the distance at the places where the plan is at its times. */
function areas_of({series}) {
  const band = sure.bands && sure.bands[series[0][0]], m = store.answer.motion, xs = abscissa(m);
  return band ? [{xs: axis.by === "time" ? band.time_s : band.time_s.map((t) => value_at(m.time_s, xs, t)), low: band.low, high: band.high, fill: color(series[0][1])}] : [];
}

function plot_of(one, redraw) {
  const content = () => {
    if (!store.answer) return null;
    const m = store.answer.motion, xs = abscissa(m), row = row_at(m.time_s, store.cursor_s);
    const now = one.series.map(([column]) => number(one.step ? m[column][row] : value_at(m.time_s, m[column], store.cursor_s), 4));
    return {lines: lines_of(one), areas: areas_of(one), band: {xs, color_of: color_at(m)}, span: axis.span, x: value_at(m.time_s, xs, store.cursor_s), now: now.join(" · ") + "\u202f" + one.unit};
  };
  const point = (x) => {
    if (!store.answer) return;
    const m = store.answer.motion;
    set_cursor(axis.by === "time" ? x : m.time_s[row_at(abscissa(m), x)]);
  };
  const zoom = (span) => { axis.span = span; redraw(); };
  return plot({title: one.title, unit: one.unit, keys: one.series.filter(([, , name]) => name).map(([, stroke, name]) => key(name, `var(--${stroke})`)), content, point, zoom});
}

/** What the interval holds: the file's constants, and the model's own error where the file states it. */
const interval_words = () => ((store.robot.uncertainty || {}).model_energy === undefined ? "95 % interval, parameters only" : "95 % interval");

/** Share of the driving time for each limit that binds. */
function legend_of(answer) {
  const m = answer.motion, share = {}, moves = (k) => m.linear_speed_m_s[k] !== 0 || m.angular_speed_rad_s[k] !== 0;
  let driven_s = 0;
  for (let k = 0; k + 1 < m.time_s.length; ++k) {
    const step_s = m.time_s[k + 1] - m.time_s[k], name = answer.limits[m.limit[k]];
    if (moves(k) || moves(k + 1)) driven_s += step_s;
    if (name) share[name] = (share[name] || 0) + step_s;
  }
  return ["Active limit: ", ...Object.entries(share).sort((a, b) => b[1] - a[1]).map(([name, time_s]) => key(`${words(name)} ${short(100 * time_s / driven_s, 2)} %`, limit_color(name), "box")),
    key("none: energy decides", free_color(), "box"),
    ...(sure.bands && Object.keys(sure.bands).length ? [key(interval_words(), "color-mix(in srgb, var(--plan) 30%, var(--ground))", "box")] : [])];
}

/** The plots with the names of the limits that bind in this plan. */
export function plots_panel() {
  const legend = h("p", {class: "legend"});
  let queued = false;
  const later = (all) => {
    if (all && store.answer) legend.replaceChildren(...legend_of(store.answer));
    if (queued) return;
    queued = true;
    requestAnimationFrame(() => { queued = false; plots.forEach((one) => one.draw()); });
  };
  const plots = kPlots.map((one) => plot_of(one, later));
  const by = (name) => button("Over " + name, (event) => {
    Object.assign(axis, {by: name, span: null});
    for (const other of event.target.parentElement.querySelectorAll("[aria-pressed]")) other.setAttribute("aria-pressed", String(other === event.target));
    later();
  }, {"aria-pressed": String(axis.by === name)});
  const load = async () => {
    const edits = store.edits, state = store.state, answer = await ask("bands", {samples: 300});
    if (!sure.shown || edits !== store.edits || state !== store.state || !answer.bands) return;
    sure.bands = answer.bands;
    later(true);
  };
  const interval = button("95 %", () => {
    sure.shown = !sure.shown;
    sure.bands = null;
    interval.setAttribute("aria-pressed", String(sure.shown));
    later(true);
    if (sure.shown) load();
  }, {"aria-pressed": "false", id: "interval", title: "the 95 % interval of power and energy that the robot's uncertainty gives"});
  const offer = () => {
    interval.hidden = !Object.keys(store.robot.uncertainty || {}).length;
    if (interval.hidden && sure.shown) Object.assign(sure, {shown: false, bands: null});
    interval.setAttribute("aria-pressed", String(sure.shown));
  };
  const all = button("All", () => { axis.span = null; later(); }, {"aria-label": "show the whole motion in the plots"});
  on("answer", () => { sure.bands = null; offer(); later(true); });
  on("settled", () => { if (sure.shown && store.answer) load(); });
  on("view", () => later(true));
  on("cursor", () => later(false));
  on_theme(() => later(true));
  window.addEventListener("resize", () => later(false));
  offer();
  return h("section", {class: "plots", "aria-label": "Plots of the motion"}, h("div", {class: "tools"}, h("div", {role: "group", "aria-label": "Axis"}, by("time"), by("distance"), all), interval), legend, plots.map((one) => one.element));
}
