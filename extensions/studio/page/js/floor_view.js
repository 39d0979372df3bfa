/** The floor on a canvas: map and masks, the way colored by speed or by the limit that binds, stops, handles, the robot. */
import {h, sharp} from "page/dom.js";
import {is_number, value_at} from "page/numbers.js";
import {draw_cross, draw_picture, draw_robot, draw_scale, draw_text, draw_way, floor_view, picture_of, rgb, show_places} from "page/floor.js";
import {on, store} from "studio/store.js";
import {color, free_color, is_dark, limit_color, on_theme, ramp} from "page/theme.js";
import {handles} from "studio/handles.js";
import {drag_text} from "studio/summary.js";

const kOccupied_percent = 65, kTools_px = 40;  // the buttons over the top of the map

/** Free, unknown, occupied, kept out, slowed. */
function picture() {
  const {map, speed_mask, keepout} = store.floor, is_occupied = (percent) => percent >= kOccupied_percent;
  const [free, unknown, occupied, slow, kept_out] = ["free", "unknown", "occupied", "slow", "keepout"].map((name) => rgb("map-" + name));
  const layers = [{grid: map, shade: (percent) => (percent < 0 ? unknown : is_occupied(percent) ? occupied : free)}];
  if (speed_mask) layers.push({grid: speed_mask.grid, shade: (value) => (value > 0 ? slow : null)});
  if (keepout) layers.push({grid: keepout, shade: (percent) => (is_occupied(percent) ? kept_out : null), keep: occupied});
  return picture_of(layers);
}

export const view = Object.assign(floor_view(), {by: "limit"});

export const canvas = h("canvas", {id: "floor", tabindex: "0", role: "application", "aria-roledescription": "map editor",
  "aria-label": "Map with the mission. N and P choose a stop or handle, arrow keys move it, brackets turn it, plus and minus zoom."});
let drawn, drawn_dark, shown = false, fitted = "";
const window_of = () => [view.scale, view.x_m, view.y_m].join();

export function show_all() {
  const m = store.answer && store.answer.motion, grid = store.floor.map, marks = handles();
  show_places(view, [...(m ? m.position_x_m : []), ...marks.map((mark) => mark.x)], [...(m ? m.position_y_m : []), ...marks.map((mark) => mark.y)], grid);
  view.scale *= 1 - kTools_px / Math.max(view.height, 2 * kTools_px);
  view.y_m += kTools_px / 2 / view.scale;
  fitted = window_of();
}

function draw_map(context) {
  const grid = store.floor.map;
  if (!grid) return;
  if (!drawn || drawn_dark !== is_dark()) { drawn = picture(); drawn_dark = is_dark(); }
  draw_picture(context, view, grid, drawn);
}
function draw_motion(context, answer, faint) {
  const m = answer.motion, v = m.linear_speed_m_s, top = Math.max(1e-9, ...v.map(Math.abs));
  const by_limit = (k) => (m.limit[k] < 0 ? free_color() : limit_color(answer.limits[m.limit[k]])), by_speed = (k) => ramp(Math.abs(v[k] + v[k - 1]) / 2 / top);
  draw_way(context, view, m.position_x_m, m.position_y_m, view.by === "limit" ? by_limit : by_speed, v, faint);
}
function draw_handle(context, handle) {
  const [px, py] = view.at(handle.x, handle.y), chosen = handle.chosen;
  context.lineWidth = chosen ? 3 : 2; context.strokeStyle = chosen ? color("focus") : color("ink"); context.fillStyle = color("map-free");
  if (handle.from) { const [fx, fy] = view.at(...handle.from); context.save(); context.lineWidth = 1.5; context.beginPath(); context.moveTo(fx, fy); context.lineTo(px, py); context.stroke(); context.restore(); }
  context.beginPath();
  if (handle.kind === "control") context.arc(px, py, 5, 0, 7);
  else if (handle.kind === "joint") context.arc(px, py, 7, 0, 7);
  else if (handle.kind === "heading") { context.fillStyle = context.strokeStyle; context.arc(px, py, 5, 0, 7); }
  else context.rect(px - 7, py - 7, 14, 14);
  context.fill(); context.stroke();
  if (handle.text) draw_text(context, view, handle.text, px, py);
}
function draw_robot_now(context) {
  if (!store.answer) return;
  const m = store.answer.motion, at = (column) => value_at(m.time_s, m[column], store.cursor_s);
  draw_robot(context, view, {x: at("position_x_m"), y: at("position_y_m"), heading: at("heading_rad")}, store.robot.footprint || {});
}
function draw_problems(context) {
  const spots = store.answer ? store.answer.legs.map((leg) => leg.blocked).filter(Boolean) : [];
  const why = store.verdict && store.verdict.infeasibility;
  if (why && is_number(why.x_m)) spots.push(why);
  spots.forEach((spot) => draw_cross(context, view, spot.x_m, spot.y_m));
}

/** Energy and time since the drag began, beside the pointer. */
function draw_drag(context) {
  const text = drag_text();
  if (!text) return;
  context.font = "600 14px system-ui, sans-serif";
  const [px, py] = store.drag.at, width = context.measureText(text).width + 14;
  const x = Math.min(px + 18, view.width - width - 4), y = Math.max(py - 34, 4);
  context.fillStyle = color("card"); context.strokeStyle = color("line"); context.lineWidth = 1;
  context.beginPath(); context.rect(x, y, width, 24); context.fill(); context.stroke();
  context.fillStyle = color("ink"); context.textAlign = "left"; context.textBaseline = "middle";
  context.fillText(text, x + 7, y + 12);
}

let queued = false;
export function draw() {
  if (queued) return;
  queued = true;
  requestAnimationFrame(() => {
    queued = false;
    if (!canvas.isConnected) return;
    const {context, width, height} = sharp(canvas);
    const grew = width !== view.width || height !== view.height;
    view.width = width; view.height = height;
    if (!shown && (store.answer || store.floor.map)) { show_all(); shown = !!store.answer; } else if (grew && window_of() === fitted) show_all();  // unless it was moved
    context.fillStyle = color(store.floor.map ? "map-unknown" : "map-free"); context.fillRect(0, 0, width, height);
    draw_map(context);
    if (store.kept) draw_motion(context, store.kept.answer, true);
    if (store.answer) draw_motion(context, store.answer, false);
    handles().forEach((handle) => draw_handle(context, handle));
    draw_robot_now(context); draw_problems(context); draw_scale(context, view); draw_drag(context);
  });
}
["answer", "edit", "selection", "cursor", "view"].forEach((event) => on(event, draw));
on_theme(draw);
new ResizeObserver(draw).observe(canvas.parentElement || document.body);
window.addEventListener("resize", draw);
