/** A plot on a canvas: lines over one axis, limits, a strip under them, a cursor. A stretch of the axis is zoomed by dragging. */
import {h, sharp} from "page/dom.js";
import {is_number, short, ticks} from "page/numbers.js";
import {color} from "page/theme.js";

/** Outlines of marks around 0; a mark without one is a circle. */
const kOutlines = {square: [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]], triangle: [[0, -1.2], [1.1, 0.8], [-1.1, 0.8]], diamond: [[0, -1.3], [1.3, 0], [0, 1.3], [-1.3, 0]],
  wedge: [[0, 1.2], [1.1, -0.8], [-1.1, -0.8]], hourglass: [[-1, -1.1], [1, -1.1], [-1, 1.1], [1, 1.1]], bow: [[-1.1, -1], [1.1, 1], [1.1, -1], [-1.1, 1]], bar: [[-1.3, -0.5], [1.3, -0.5], [1.3, 0.5], [-1.3, 0.5]],
  post: [[-0.5, -1.3], [0.5, -1.3], [0.5, 1.3], [-0.5, 1.3]], house: [[0, -1.3], [1, -0.2], [1, 1], [-1, 1], [-1, -0.2]]};
export const kMarks = ["circle", ...Object.keys(kOutlines)];
function draw_mark(context, x, y, mark, size) {
  const outline = kOutlines[mark];
  context.beginPath();
  if (outline) outline.forEach(([right, down]) => context.lineTo(x + size * right, y + size * down)); else context.arc(x, y, size, 0, 7);
  context.closePath(); context.lineWidth = 1.6; context.stroke();
}
/** A mark as a picture, for a legend. */
export function mark_picture(mark, stroke) {
  const element = (tag, attributes, ...children) => { const node = document.createElementNS("http://www.w3.org/2000/svg", tag); Object.entries(attributes).forEach(([name, value]) => node.setAttribute(name, value)); node.append(...children); return node; };
  const shape = kOutlines[mark] ? element("polygon", {points: kOutlines[mark].map((corner) => corner.map((part) => 4.5 * part).join(",")).join(" ")}) : element("circle", {r: 4.5});
  return element("svg", {viewBox: "-7 -1.5 14 3", width: 14, height: 3, "aria-hidden": "true", style: `flex:none;overflow:visible;fill:none;stroke:${stroke};stroke-width:1.6`}, shape);
}

const kLeft = 54, kRight = 10, kTop = 8, kBottom = 20, kLabel = 17, kBand = 6, kDrag_px = 8;

/** Whether a limit is near enough to what is drawn to be shown. */
const near = (limit, low, high) => Math.abs(limit) < 4 * Math.max(-low, high);

/** What lies between the ends of the axis: [low, high] of both directions. */
function ranges_of(shown) {
  let x0 = Infinity, x1 = -Infinity, low = shown.fitted ? Infinity : 0, high = shown.fitted ? -Infinity : 0;
  for (const {xs} of shown.lines) if (xs.length) { x0 = Math.min(x0, xs[0]); x1 = Math.max(x1, xs.at(-1)); }
  if (!shown.fitted) x0 = Math.min(0, x0);
  if (shown.span) [x0, x1] = shown.span;
  for (const {xs, ys} of [...shown.lines, ...(shown.areas || []).flatMap(({xs, low: from, high: to}) => [{xs, ys: from}, {xs, ys: to}])])
    ys.forEach((y, k) => { if (is_number(y) && xs[k] >= x0 && xs[k] <= x1) { low = Math.min(low, y); high = Math.max(high, y); } });
  if (!(high >= low)) [low, high] = [0, 1];
  for (const limit of shown.limits || []) if (near(limit, low, high)) { low = Math.min(low, limit); high = Math.max(high, limit); }
  const margin = 0.06 * (high - low) || 1;
  return {x0, x1: x1 > x0 ? x1 : x0 + 1, low: low < 0 || shown.fitted ? low - margin : low, high: high + margin};
}

function frame_of(shown, width, height) {
  const {x0, x1, low, high} = ranges_of(shown), bottom = height - kBottom - (shown.label ? kLabel : 0), base = bottom - (shown.band ? kBand : 0);
  return {x0, x1, low, high, width, bottom, X: (x) => kLeft + (width - kLeft - kRight) * (x - x0) / (x1 - x0), Y: (y) => kTop + (base - kTop) * (high - y) / (high - low),
    back: (px) => x0 + (px - kLeft) * (x1 - x0) / (width - kLeft - kRight)};
}

function draw_axes(context, frame, label) {
  const {x0, x1, low, high, width, bottom, X, Y} = frame;
  context.font = "11px system-ui, sans-serif"; context.fillStyle = color("soft"); context.strokeStyle = color("grid"); context.lineWidth = 1;
  context.textAlign = "right"; context.textBaseline = "middle";
  for (const tick of ticks(low, high, bottom / 30)) { context.beginPath(); context.moveTo(kLeft, Y(tick)); context.lineTo(width - kRight, Y(tick)); context.stroke(); context.fillText(short(tick, 5), kLeft - 5, Y(tick)); }
  context.textAlign = "center"; context.textBaseline = "top";
  for (const tick of ticks(x0, x1, width / 75)) context.fillText(short(tick, 5), Math.min(X(tick), width - 16), bottom + 4);
  if (label) context.fillText(label, (kLeft + width - kRight) / 2, bottom + kBottom);
}

function draw_line(context, frame, {xs, ys, stroke, dash, width = 1.6, step, dots, apart, mark}) {
  const {X, Y} = frame;
  context.strokeStyle = context.fillStyle = stroke; context.lineWidth = width; context.setLineDash(dash || []);
  context.beginPath();
  let drawing = false;
  ys.forEach((y, k) => {
    if (!is_number(y)) { drawing = drawing && dots > 0; return; }  // points of a curve are joined over gaps, samples are not
    if (drawing) context.lineTo(X(xs[k]), Y(y)); else context.moveTo(X(xs[k]), Y(y));
    drawing = true;
    if (step && k + 1 < xs.length) context.lineTo(X(xs[k + 1]), Y(y));
  });
  if (!apart) context.stroke();
  context.setLineDash([]);
  if (mark) ys.forEach((y, k) => { if (is_number(y)) draw_mark(context, X(xs[k]), Y(y), mark, dots); });
  else if (dots) ys.forEach((y, k) => { if (is_number(y)) { context.beginPath(); context.arc(X(xs[k]), Y(y), dots, 0, 7); context.fill(); } });
}

function draw_area(context, {X, Y}, {xs, low, high, fill}) {
  context.fillStyle = fill; context.globalAlpha = 0.22;
  context.beginPath();
  xs.forEach((x, k) => context.lineTo(X(x), Y(low[k])));
  for (let k = xs.length - 1; k >= 0; --k) context.lineTo(X(xs[k]), Y(high[k]));
  context.fill();
  context.globalAlpha = 1;
}

function draw_limits(context, {X, Y, x0, x1, low, high}, limits) {
  context.strokeStyle = color("limit"); context.lineWidth = 1.3; context.setLineDash([7, 4]);
  for (const limit of limits) if (limit >= low && limit <= high) { context.beginPath(); context.moveTo(X(x0), Y(limit)); context.lineTo(X(x1), Y(limit)); context.stroke(); }
  context.setLineDash([]);
}

function draw_band(context, {X, bottom}, {xs, color_of}) {
  for (let k = 0; k + 1 < xs.length; ++k) {
    context.fillStyle = color_of(k);
    context.fillRect(X(xs[k]), bottom - kBand, Math.max(0.7, X(xs[k + 1]) - X(xs[k]) + 0.4), kBand);
  }
}

function draw_content(context, frame, shown, height) {
  context.save();
  const beside = shown.span ? 0 : 4;  // dots at the ends of the axis are not cut
  context.beginPath(); context.rect(kLeft - beside, 0, frame.width - kLeft - kRight + 2 * beside, height); context.clip();
  if (shown.band) draw_band(context, frame, shown.band);
  for (const area of shown.areas || []) draw_area(context, frame, area);
  draw_limits(context, frame, shown.limits || []);
  for (const line of shown.lines) draw_line(context, frame, line);
  if (is_number(shown.x)) {
    const x = frame.X(shown.x);
    context.strokeStyle = color("focus"); context.lineWidth = 1.5;
    context.beginPath(); context.moveTo(x, kTop); context.lineTo(x, frame.bottom); context.stroke();
  }
  context.restore();
}

/** Dragging the mouse selects a stretch of the axis; a double-click shows all again. */
function listen(canvas, frame_now, {point, zoom}, selected) {
  const place = (event) => event.clientX - canvas.getBoundingClientRect().left;
  let from = null;
  const tell = (event) => { const frame = frame_now(); if (frame) point(Math.min(frame.x1, Math.max(frame.x0, frame.back(place(event))))); };
  canvas.addEventListener("pointerdown", (event) => { if (zoom && event.pointerType === "mouse") from = place(event); tell(event); });
  canvas.addEventListener("pointermove", (event) => {
    if (from !== null && Math.abs(place(event) - from) > kDrag_px) { canvas.setPointerCapture(event.pointerId); selected([from, place(event)]); }
    tell(event);
  });
  const lift = (event) => {
    const frame = frame_now();
    if (from !== null && frame && event.type === "pointerup" && Math.abs(place(event) - from) > kDrag_px)
      zoom([from, place(event)].sort((a, b) => a - b).map((px) => Math.min(frame.x1, Math.max(frame.x0, frame.back(px)))));
    from = null;
    selected(null);
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  if (zoom) canvas.addEventListener("dblclick", () => zoom(null));
}

/**
 * {title, unit, keys, tall, content(), point(x), zoom(span)}: `point` is told where the pointer is, `zoom` which stretch
 * was chosen (null: all). content() gives what is drawn now, or null:
 *   lines   [{xs, ys, stroke, dash, width, step, dots, apart, mark}]; ys hold null where there is nothing; apart: dots alone;
 *           mark: one of kMarks instead of a full dot
 *   areas   [{xs, low, high, fill}], bands under the lines
 *   limits  heights of dashed lines          fitted  whether the range follows the lines alone instead of holding 0
 *   band    {xs, color_of(row)}, a strip     span    the stretch of the axis that is shown
 *   x       place of the cursor              now, label   text of the values there, of the axis
 * Gives {element, draw(), span()}.
 */
export function plot({title, unit, keys = [], tall, content, point, zoom}) {
  const canvas = h("canvas", {role: "img", "aria-label": `${title} in ${unit}`}), now = h("span", {class: "now"});
  const element = h("div", {class: "plot-block"}, h("div", {class: "plot-head"}, h("h3", {}, title), h("span", {class: "soft"}, unit), keys, now),
    h("div", {class: "plot" + (tall ? " tall" : "")}, canvas));
  let frame = null, selected = null;
  function draw() {
    const shown = content();
    if (!shown || !canvas.isConnected || !canvas.parentElement.clientWidth) return;
    const {context, width, height} = sharp(canvas);
    frame = frame_of(shown, width, height);
    context.clearRect(0, 0, width, height);
    draw_axes(context, frame, shown.label);
    draw_content(context, frame, shown, height);
    if (selected) { context.fillStyle = color("focus"); context.globalAlpha = 0.25; context.fillRect(selected[0], kTop, selected[1] - selected[0], frame.bottom - kTop); context.globalAlpha = 1; }
    now.textContent = shown.now || "";
  }
  listen(canvas, () => frame, {point, zoom}, (next) => { if (selected || next) { selected = next; draw(); } });
  return {element, draw, span: () => frame && [frame.x0, frame.x1]};
}
