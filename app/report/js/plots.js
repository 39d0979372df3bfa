/* Line plots by dygraphs, and the cursor that several of them (and the map) share. */

/** Straight lines through values[name] drawn as limits: dashes at the ink of the theme. */
jp.draw_limits = function (context, area, graph, limits) {
  context.save();
  context.strokeStyle = jp.color("limit");
  context.lineWidth = 1.3;
  context.setLineDash([7, 4]);
  for (const value of limits) {
    const y = graph.toDomYCoord(value);
    if (y < area.y || y > area.y + area.h) continue;
    context.beginPath(); context.moveTo(area.x, y); context.lineTo(area.x + area.w, y); context.stroke();
  }
  context.restore();
};

/** [low, high] including the limits, if they are not far outside of the drawn values; else null: fitted to the values. */
jp.range_with_limits = function (series, limits) {
  if (!limits.length) return null;
  let low = 0, high = 0;
  for (const one of series) for (const value of one.values) if (jp.is_number(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  const reach = 4 * Math.max(-low, high);
  limits.filter((limit) => Math.abs(limit) < reach).forEach((limit) => { low = Math.min(low, limit); high = Math.max(high, limit); });
  const margin = 0.06 * (high - low) || 1;
  return [low < 0 ? low - margin : 0, high + margin];
};

/**
 * One plot: {title, unit, series: [{name, values, color, dash}], limits: [numbers], x, x_label, cursor, tall}.
 * Returns {element, graph, set_x(values, label), show(row)}.
 */
jp.plot = function (options) {
  const {title, unit, series, limits = [], cursor} = options;
  const now = jp.h("span", {class: "now"});
  const keys = series.map((one) => jp.key(one.name, `var(--${one.color})`, one.dash ? "dash" : ""));
  if (limits.length) keys.push(jp.key("limit", "var(--limit)", "dash"));
  const place = jp.h("div", {class: "plot" + (options.tall ? " tall" : ""), role: "img", "aria-label": `${title} in ${unit}: ${series.map((one) => one.name).join(", ")}`});
  const element = jp.h("div", {class: "plot-block"}, jp.h("div", {class: "plot-head"}, jp.h("b", {}, title), jp.h("span", {class: "soft"}, unit), ...keys, now), place);
  const rows = (x) => Array.from(x, (value, row) => [value, ...series.map((one) => one.values[row] ?? null)]);
  let x = options.x;
  const value_range = jp.range_with_limits(series, limits);
  const graph_options = () => ({
    labels: ["x", ...series.map((one) => one.name)],
    colors: series.map((one) => jp.color(one.color)),
    series: Object.fromEntries(series.map((one) => [one.name, {strokePattern: one.dash || null, strokeWidth: one.width || 1.6, drawPoints: !!one.points, pointSize: one.points || 0, stepPlot: !!one.step}])),
    gridLineColor: jp.color("grid"), axisLineColor: jp.color("line"), gridLineWidth: 1,
    xlabel: options.x_label || null, xLabelHeight: 16, axes: {y: {axisLabelWidth: 52, pixelsPerLabel: 24, axisLabelFormatter: (value) => jp.short(value, 4)}, x: {axisLabelFormatter: (value) => jp.short(value, 5), valueFormatter: String}},
    legend: "never", showLabelsOnHighlight: false, highlightCircleSize: 4, animatedZooms: false, connectSeparatedPoints: true, includeZero: !!options.include_zero,
    underlayCallback: (context, area, graph) => jp.draw_limits(context, area, graph, limits),
    valueRange: value_range,
  });
  let graph;
  const plot = {element, place, get graph() { return graph; },
    draw() {
      graph = new Dygraph(place, rows(x), {...graph_options(), width: place.clientWidth || 600, height: place.clientHeight || 150,
        highlightCallback: (_event, _x, _points, row) => cursor && cursor.set(row, plot),
        zoomCallback: (from, to) => cursor && cursor.zoom(plot, [from, to])});
      jp.plots.push(plot);
    },
    label(text) { options.x_label = text; },
    redraw() { graph.updateOptions({...graph_options()}); graph.resize(place.clientWidth, place.clientHeight); },
    set_x(values, label) { x = values; options.x_label = label; graph.updateOptions({file: rows(x), xlabel: label, dateWindow: null, valueRange: value_range}); },
    show(row) {
      graph.setSelection(row);
      now.textContent = series.map((one) => jp.number(one.values[row], 4)).join(" · ") + "\u202f" + unit;
    },
    zoom(range) { graph.updateOptions({dateWindow: range}); }};
  if (cursor) cursor.add(plot);
  return plot;
};

/** The shared cursor: a slider (keyboard and touch), a readout, and all views that follow a row. */
jp.cursor = function (count, describe) {
  const followers = [];
  const plots = [];
  const readout = jp.h("div", {class: "readout", "aria-live": "polite"}, "Move over a plot or the map, or use the slider and its arrow keys.");
  const slider = jp.h("input", {type: "range", min: 0, max: Math.max(count - 1, 0), value: 0, id: jp.unique_id("cursor"), "aria-label": "Position of the cursor along the motion"});
  const cursor = {row: -1, slider, readout, element: jp.h("div", {class: "cursor"}, slider, readout),
    add: (plot) => plots.push(plot),
    follow: (listener) => followers.push(listener),
    set(row, from) {
      if (row === cursor.row || row < 0 || row >= count) return;
      cursor.row = row;
      slider.value = row;
      const text = describe(row);
      readout.textContent = text;
      slider.setAttribute("aria-valuetext", text);
      plots.forEach((plot) => plot.show(row, plot === from));
      followers.forEach((listener) => listener(row));
    },
    zoom(from, range) { plots.forEach((plot) => plot !== from && plot.zoom(range)); },
    reset() { plots.forEach((plot) => plot.graph.resetZoom()); }};
  slider.addEventListener("input", () => cursor.set(Number(slider.value)));
  slider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? Math.max(1, Math.round(count / 50)) : 0;
    if (step && (event.key === "ArrowRight" || event.key === "ArrowLeft")) {
      cursor.set(Math.min(count - 1, Math.max(0, cursor.row + (event.key === "ArrowRight" ? step : -step))));
      event.preventDefault();
    }
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "0" && !/INPUT|SELECT|TEXTAREA/.test(event.target.tagName) || (event.key === "0" && event.target === slider)) cursor.reset();
  });
  return cursor;
};

/** Draws the plots of the page and adapts them to the theme, the window and the paper. */
jp.draw_plots = function (plots) {
  plots.forEach((plot) => plot.draw());
  const redraw = () => plots.forEach((plot) => plot.redraw());
  jp.redraws.push(redraw);
  window.addEventListener("resize", redraw);
};
