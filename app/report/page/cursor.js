/** A cursor over rows that several plots (and a map) share: a slider for keys and touch, a readout, the stretch that is shown. */
import {h, key} from "page/dom.js";
import {number, row_at, value_at} from "page/numbers.js";
import {mark_picture, plot} from "page/plot.js";
import {color} from "page/theme.js";

let cursors = 0;

/** {row, span, plots, element, follow(listener), draw(), set(row), zoom(span)}; `describe(row)` is the readout. */
export function cursor(count, describe) {
  const followers = [];
  const readout = h("div", {class: "readout", "aria-live": "polite"}, "Move over a plot or the map, or use the slider and its arrow keys.");
  const slider = h("input", {type: "range", min: 0, max: Math.max(count - 1, 0), value: 0, id: "cursor" + (cursors++ || ""), "aria-label": "Position of the cursor along the motion"});
  const self = {row: -1, span: null, plots: [], element: h("div", {class: "cursor"}, slider, readout),
    follow: (listener) => followers.push(listener),
    draw: () => self.plots.forEach((one) => one.draw()),
    set(row) {
      if (row === self.row || row < 0 || row >= count) return;
      self.row = row;
      slider.value = row;
      readout.textContent = describe(row);
      slider.setAttribute("aria-valuetext", readout.textContent);
      self.draw();
      followers.forEach((listener) => listener(row));
    },
    zoom(span) { self.span = span; self.draw(); }};
  slider.addEventListener("input", () => self.set(Number(slider.value)));
  slider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? Math.max(1, Math.round(count / 50)) : 0;
    if (step && (event.key === "ArrowRight" || event.key === "ArrowLeft")) {
      self.set(Math.min(count - 1, Math.max(0, self.row + (event.key === "ArrowRight" ? step : -step))));
      event.preventDefault();
    }
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "0" && (!/INPUT|SELECT|TEXTAREA/.test(event.target.tagName) || event.target === slider)) self.zoom(null);
  });
  return self;
}

/**
 * A plot that follows a cursor: {title, unit, series: [{name, values, color, dash, width, points, mark, xs(), curve: {xs, ys}, band:
 * {xs(), low, high}}], limits: [numbers], x(), x_label(), cursor, tall, fitted}. x() is the axis of the cursor's rows; a
 * series may have its own. A curve joins the points of its series; marks are not joined, and only legend and readout name them.
 */
export function row_plot({title, unit, series, limits = [], cursor: shared, x, x_label, tall, fitted}) {
  const keys = series.map((one) => key(one.name, `var(--${one.color})`, one.mark ? mark_picture(one.mark, `var(--${one.color})`) : one.dash || ""));
  if (series.some((one) => one.band)) keys.push(key("95 % interval", "color-mix(in srgb, var(--plan) 30%, var(--ground))", "box"));
  if (limits.length) keys.push(key("limit", "var(--limit)", [7, 4]));
  const xs_of = (one) => (one.xs || x)();
  const now = (at) => series.filter((one) => !one.mark).map((one) => number(one.xs ? value_at(xs_of(one), one.values, at) : one.values[shared.row], 4)).join(" · ") + "\u202f" + unit;
  const content = () => {
    const at = shared.row < 0 ? null : x()[shared.row];
    const line = (one) => ({xs: xs_of(one), ys: one.values, stroke: color(one.color), dash: one.dash, width: one.width, dots: one.points, mark: one.mark, apart: !!(one.curve || one.mark)});
    const area = ({band, color: name}) => ({xs: band.xs(), low: band.low, high: band.high, fill: color(name)});
    return {areas: series.filter((one) => one.band).map(area), lines: series.flatMap((one) => [...(one.curve ? [{...line(one), ...one.curve, dots: 0, apart: false}] : []), line(one)]), limits, label: x_label && x_label(),
      fitted, span: shared.span, x: at, now: at === null ? "" : now(at)};
  };
  const drawn = plot({title, unit, keys, tall, content, point: (at) => shared.set(row_at(x(), at)), zoom: shared.zoom});
  shared.plots.push(drawn);
  return drawn;
}
