/** Plots of a report over the rows of a cursor. */
import {cursor, row_plot} from "page/cursor.js";
import {button, h} from "page/dom.js";
import {jp} from "report/core.js";

/** Cumulative distance driven, m, from speed and time: dwells and turns in place add nothing. */
jp.distance = function (columns) {
  const t = columns.time_s, v = columns.linear_speed_m_s || [], s = new Array(t.length).fill(0);
  for (let k = 1; k < t.length; ++k) s[k] = s[k - 1] + 0.5 * (Math.abs(v[k] || 0) + Math.abs(v[k - 1] || 0)) * (t[k] - t[k - 1]);
  return s;
};

/** Time or distance driven as the axis of the plots of a shared cursor: {of(columns), label, element}. */
jp.axis = function (shared) {
  const distance = new Map();
  let by = "time";
  const driven = (columns) => { if (!distance.has(columns)) distance.set(columns, jp.distance(columns)); return distance.get(columns); };
  const choose = (name) => () => {
    by = name;
    buttons.forEach((one) => one.setAttribute("aria-pressed", String(one.dataset.by === by)));
    shared.zoom(null);
  };
  const buttons = ["time", "distance"].map((name) => button(`Over ${name}, ${name === "time" ? "s" : "m"}`, choose(name), {"data-by": name, "aria-pressed": String(name === by)}));
  return {of: (columns) => (by === "time" ? columns.time_s : driven(columns)), label: () => (by === "time" ? "time, s" : "distance, m"),
    element: h("div", {class: "tools"}, buttons, button("All", () => shared.zoom(null)))};
};

/**
 * {title, unit, series: [{name, values, color, dash, width, points, xs()}], limits: [numbers], x(), x_label(), cursor, tall, fitted}:
 * x() is the axis of the cursor's rows; a series may have its own.
 */
jp.plot = function (options) {
  const drawn = row_plot(options);
  jp.plots.push(drawn);
  return drawn;
};

/** A cursor whose plots follow the theme and the window. */
jp.cursor = function (count, describe) {
  const one = cursor(count, describe);
  jp.redraws.push(one.draw);
  return one;
};
