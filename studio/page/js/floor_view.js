/** The floor on a canvas: map and masks, the way colored by speed or by the limit that binds, stops, handles, the robot. */
import {h, sharp} from "studio/dom.js";
import {is_number, value_at} from "studio/numbers.js";
import {on, store} from "studio/store.js";
import {color, free_color, is_dark, limit_color, on_theme, ramp} from "studio/theme.js";
import {handles} from "studio/handles.js";

const kOccupied_percent = 65;

/** A map as one picture: free, unknown, occupied, keep-out and speed-limited cells. */
function picture_of(floor) {
  const grid = floor.map, canvas = document.createElement("canvas");
  canvas.width = grid.width; canvas.height = grid.height;
  const context = canvas.getContext("2d"), image = context.createImageData(grid.width, grid.height);
  const rgb = (name) => [1, 3, 5].map((at) => parseInt(color(name).slice(at, at + 2), 16));
  const free = rgb("map-free"), unknown = rgb("map-unknown"), occupied = rgb("map-occupied");
  paint(grid, image, grid, (percent) => (percent < 0 ? unknown : percent >= kOccupied_percent ? occupied : free));
  if (floor.speed_mask) paint(floor.speed_mask.grid, image, grid, (value) => (value > 0 ? rgb("map-slow") : null));
  if (floor.keepout) paint(floor.keepout, image, grid, (percent) => (percent >= kOccupied_percent ? rgb("map-keepout") : null), occupied);
  context.putImageData(image, 0, 0);
  return canvas;
}
function paint(mask, image, grid, shade, keep) {
  const aligned = mask.width === grid.width && mask.height === grid.height && mask.origin.every((v, k) => Math.abs(v - grid.origin[k]) < 1e-9);
  let cell = 0;
  for (let k = 0; k < mask.runs.length; k += 2) {
    const rgb = shade(mask.runs[k]);
    for (let n = 0; n < mask.runs[k + 1]; ++n, ++cell) {
      if (!rgb) continue;
      let column = cell % mask.width, row = Math.floor(cell / mask.width);
      if (!aligned) {
        column = Math.floor((mask.origin[0] + (column + 0.5) * mask.resolution_m - grid.origin[0]) / grid.resolution_m);
        row = Math.floor((mask.origin[1] + (row + 0.5) * mask.resolution_m - grid.origin[1]) / grid.resolution_m);
        if (column < 0 || row < 0 || column >= grid.width || row >= grid.height) continue;
      }
      const at = 4 * ((grid.height - 1 - row) * grid.width + column);
      if (keep && image.data[at] === keep[0] && image.data[at + 1] === keep[1]) continue;
      image.data[at] = rgb[0]; image.data[at + 1] = rgb[1]; image.data[at + 2] = rgb[2]; image.data[at + 3] = 255;
    }
  }
}

export const view = {scale: 1, x_m: 0, y_m: 0, width: 0, height: 0, by: "limit",
  at(x, y) { return [view.width / 2 + (x - view.x_m) * view.scale, view.height / 2 - (y - view.y_m) * view.scale]; },
  back(px, py) { return [view.x_m + (px - view.width / 2) / view.scale, view.y_m - (py - view.height / 2) / view.scale]; },
  /** Shows a box of the map with a margin. */
  show(x0, y0, x1, y1) {
    view.x_m = (x0 + x1) / 2; view.y_m = (y0 + y1) / 2;
    view.scale = 0.88 * Math.min(view.width / Math.max(1, x1 - x0), view.height / Math.max(1, y1 - y0));
  },
  zoom(factor, px, py) {
    const [x, y] = view.back(px, py);
    view.scale = Math.min(2000, Math.max(2, view.scale * factor));
    const [qx, qy] = view.at(x, y);
    view.x_m += (qx - px) / view.scale; view.y_m -= (qy - py) / view.scale;
  }};

export const canvas = h("canvas", {id: "floor", tabindex: "0", role: "application", "aria-roledescription": "map editor",
  "aria-label": "Map with the mission. N and P choose a stop or handle, arrow keys move it, brackets turn it, plus and minus zoom."});
let picture, picture_dark, shown = false;

export function show_all() {
  const m = store.answer && store.answer.motion, grid = store.floor.map, marks = handles();
  const xs = [...(m ? m.position_x_m : []), ...marks.map((mark) => mark.x)], ys = [...(m ? m.position_y_m : []), ...marks.map((mark) => mark.y)];
  if (xs.length) view.show(Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys));
  else if (grid) view.show(grid.origin[0], grid.origin[1], grid.origin[0] + grid.width * grid.resolution_m, grid.origin[1] + grid.height * grid.resolution_m);
}

function draw_map(context) {
  const grid = store.floor.map;
  if (!grid) return;
  if (!picture || picture_dark !== is_dark()) { picture = picture_of(store.floor); picture_dark = is_dark(); }
  const [ox, oy] = view.at(grid.origin[0], grid.origin[1]), w = grid.width * grid.resolution_m * view.scale, tall = grid.height * grid.resolution_m * view.scale;
  context.save();
  context.translate(ox, oy); context.rotate(-grid.origin[2]);
  context.imageSmoothingEnabled = view.scale * grid.resolution_m < 1;
  context.drawImage(picture, 0, -tall, w, tall);
  context.restore();
}
function draw_way(context, answer, faint) {
  const m = answer.motion, x = m.position_x_m, y = m.position_y_m;
  const top = Math.max(1e-9, ...m.linear_speed_m_s.map(Math.abs));
  context.lineCap = context.lineJoin = "round";
  context.beginPath(); x.forEach((_, k) => context.lineTo(...view.at(x[k], y[k])));
  context.lineWidth = faint ? 2 : 9; context.strokeStyle = faint ? color("soft") : color("map-free");
  if (faint) context.setLineDash([6, 5]);
  context.stroke(); context.setLineDash([]);
  if (faint) return;
  context.lineWidth = 5;
  for (let k = 1; k < x.length; ++k) {
    if (x[k] === x[k - 1] && y[k] === y[k - 1]) continue;
    context.strokeStyle = view.by === "limit" ? (m.limit[k] < 0 ? free_color() : limit_color(answer.limits[m.limit[k]])) : ramp(Math.abs(m.linear_speed_m_s[k] + m.linear_speed_m_s[k - 1]) / 2 / top);
    context.beginPath(); context.moveTo(...view.at(x[k - 1], y[k - 1])); context.lineTo(...view.at(x[k], y[k])); context.stroke();
  }
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
  if (!handle.text) return;
  context.font = "600 13px system-ui, sans-serif";
  const wide = context.measureText(handle.text).width, left = px + 12 + wide > view.width ? px - 12 - wide : px + 12;
  context.lineWidth = 4; context.strokeStyle = color("map-free"); context.strokeText(handle.text, left, py - 10);
  context.fillStyle = color("ink"); context.fillText(handle.text, left, py - 10);
}
function draw_robot(context) {
  if (!store.answer) return;
  const m = store.answer.motion, t = store.cursor_s, at = (column) => value_at(m.time_s, m[column], t);
  const [px, py] = view.at(at("position_x_m"), at("position_y_m")), foot = store.robot.footprint || {};
  context.save(); context.translate(px, py); context.rotate(-at("heading_rad"));
  context.fillStyle = color("focus"); context.strokeStyle = color("ink"); context.lineWidth = 1.5;
  context.beginPath();
  if (foot.polygon_m) foot.polygon_m.forEach(([x, y]) => context.lineTo(x * view.scale, -y * view.scale));
  else context.arc(0, 0, Math.max(3, (foot.radius_m || 0.2) * view.scale), 0, 7);
  context.closePath(); context.globalAlpha = 0.45; context.fill(); context.globalAlpha = 1; context.stroke();
  const r = Math.max(8, (foot.radius_m || 0.25) * view.scale * 0.8);
  context.beginPath(); context.moveTo(r, 0); context.lineTo(-0.5 * r, 0.55 * r); context.lineTo(-0.2 * r, 0); context.lineTo(-0.5 * r, -0.55 * r); context.closePath(); context.fill(); context.stroke();
  context.restore();
}
function draw_problems(context) {
  const spots = store.answer ? store.answer.legs.map((leg) => leg.blocked).filter(Boolean) : [];
  const why = store.verdict && store.verdict.infeasibility;
  if (why && is_number(why.x_m)) spots.push(why);
  context.strokeStyle = color("limit"); context.lineWidth = 4;
  for (const spot of spots) {
    const [px, py] = view.at(spot.x_m, spot.y_m);
    context.beginPath(); context.arc(px, py, 16, 0, 7); context.moveTo(px - 10, py - 10); context.lineTo(px + 10, py + 10); context.moveTo(px + 10, py - 10); context.lineTo(px - 10, py + 10); context.stroke();
  }
}
function draw_scale(context) {
  const wish = 110 / view.scale, power = 10 ** Math.floor(Math.log10(wish)), length = [1, 2, 5, 10].map((m) => m * power).filter((m) => m <= wish).pop();
  const bottom = view.height - 12;
  context.fillStyle = color("map-free"); context.globalAlpha = 0.85; context.fillRect(8, bottom - 20, length * view.scale + 16, 26); context.globalAlpha = 1;
  context.strokeStyle = context.fillStyle = color("ink"); context.lineWidth = 2; context.font = "12px system-ui, sans-serif";
  context.beginPath(); context.moveTo(16, bottom); context.lineTo(16 + length * view.scale, bottom); context.stroke();
  context.fillText(Number(length.toPrecision(1)) + " m", 16, bottom - 5);
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
    if (!shown && (store.answer || store.floor.map)) { show_all(); shown = !!store.answer; } else if (grew && !shown) show_all();
    context.fillStyle = color(store.floor.map ? "map-unknown" : "map-free"); context.fillRect(0, 0, width, height);
    draw_map(context);
    if (store.kept) draw_way(context, store.kept.answer, true);
    if (store.answer) draw_way(context, store.answer, false);
    handles().forEach((handle) => draw_handle(context, handle));
    draw_robot(context); draw_problems(context); draw_scale(context);
  });
}
["answer", "edit", "selection", "cursor", "view"].forEach((event) => on(event, draw));
on_theme(draw);
new ResizeObserver(draw).observe(canvas.parentElement || document.body);
window.addEventListener("resize", draw);
