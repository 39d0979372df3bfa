/** The floor on a canvas: map and masks, ways, the robot, texts, a scale. Places in meters, north up. */
import {color} from "page/theme.js";

/** A part of the floor on a canvas of `width` by `height` pixels. */
export const floor_view = () => {
  const view = {scale: 1, x_m: 0, y_m: 0, width: 0, height: 0,
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
  return view;
};
/** The corners of a map: [{x, y}]. */
export function corners_of(grid) {
  const [x, y, heading] = grid.origin, c = Math.cos(heading), s = Math.sin(heading), wide = grid.width * grid.resolution_m, tall = grid.height * grid.resolution_m;
  return [[0, 0], [wide, 0], [wide, tall], [0, tall]].map(([u, v]) => ({x: x + c * u - s * v, y: y + s * u + c * v}));
}
/** The box around places: [x0, y0, x1, y1]. */
export function box_of(xs, ys) {
  const low = (values) => values.reduce((a, b) => Math.min(a, b), Infinity), high = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
  return [low(xs), low(ys), high(xs), high(ys)];
}
/** Shows places of a list, or the whole map where there is none. */
export function show_places(view, xs, ys, grid) {
  if (xs.length) view.show(...box_of(xs, ys));
  else if (grid) show_places(view, corners_of(grid).map((one) => one.x), corners_of(grid).map((one) => one.y));
}

export const rgb = (name) => [1, 3, 5].map((at) => parseInt(color(name).slice(at, at + 2), 16));

/** Grids in one picture. A layer is {grid, shade(value) -> [r, g, b] or null, under: colors that it does not cover}; the first one has the picture's cells. */
export function picture_of(layers) {
  const [{grid}] = layers, canvas = document.createElement("canvas");
  canvas.width = grid.width; canvas.height = grid.height;
  const context = canvas.getContext("2d"), image = context.createImageData(grid.width, grid.height);
  for (const layer of layers) paint(layer, image, grid);
  context.putImageData(image, 0, 0);
  return canvas;
}
/** Run lengths [value, count, value, count ...] from the bottom row up. */
function paint({grid: mask, shade, keep}, image, grid) {
  const aligned = mask.width === grid.width && mask.height === grid.height && mask.origin.every((v, k) => Math.abs(v - grid.origin[k]) < 1e-9);
  let cell = 0;
  for (let k = 0; k < mask.runs.length; k += 2) {
    const paint_of = shade(mask.runs[k]);
    for (let n = 0; n < mask.runs[k + 1]; ++n, ++cell) {
      if (!paint_of) continue;
      let column = cell % mask.width, row = Math.floor(cell / mask.width);
      if (!aligned) {
        column = Math.floor((mask.origin[0] + (column + 0.5) * mask.resolution_m - grid.origin[0]) / grid.resolution_m);
        row = Math.floor((mask.origin[1] + (row + 0.5) * mask.resolution_m - grid.origin[1]) / grid.resolution_m);
        if (column < 0 || row < 0 || column >= grid.width || row >= grid.height) continue;
      }
      const at = 4 * ((grid.height - 1 - row) * grid.width + column);
      if (keep && image.data[at] === keep[0] && image.data[at + 1] === keep[1]) continue;
      image.data[at] = paint_of[0]; image.data[at + 1] = paint_of[1]; image.data[at + 2] = paint_of[2]; image.data[at + 3] = 255;
    }
  }
}
export function draw_picture(context, view, grid, picture) {
  const [ox, oy] = view.at(grid.origin[0], grid.origin[1]), w = grid.width * grid.resolution_m * view.scale, tall = grid.height * grid.resolution_m * view.scale;
  context.save();
  context.translate(ox, oy); context.rotate(-grid.origin[2]);
  context.imageSmoothingEnabled = view.scale * grid.resolution_m < 1;
  context.drawImage(picture, 0, -tall, w, tall);
  context.restore();
}

/** A way on a light ground, each piece in its color, with a light core where `speed` is negative: in reverse;
 *  `faint`: dashed and gray. */
export function draw_way(context, view, x, y, color_of, speed = [], faint = false) {
  context.lineCap = context.lineJoin = "round";
  context.beginPath(); x.forEach((_, k) => context.lineTo(...view.at(x[k], y[k])));
  context.lineWidth = faint ? 2 : 9; context.strokeStyle = faint ? color("soft") : color("map-free");
  if (faint) context.setLineDash([6, 5]);
  context.stroke(); context.setLineDash([]);
  if (faint) return;
  const backward = (k) => speed[k - 1] + speed[k] < 0;
  for (const core of [false, true])
    for (let k = 1; k < x.length; ++k) {
      if ((x[k] === x[k - 1] && y[k] === y[k - 1]) || (core && !backward(k))) continue;
      context.lineWidth = core ? 1.5 : 5; context.strokeStyle = core ? color("map-free") : color_of(k);
      context.beginPath(); context.moveTo(...view.at(x[k - 1], y[k - 1])); context.lineTo(...view.at(x[k], y[k])); context.stroke();
    }
}

/** A text beside a place, above those that are there already (`taken`: their places). */
export function draw_text(context, view, text, px, py, taken = []) {
  context.font = "600 13px system-ui, sans-serif"; context.textAlign = "left"; context.textBaseline = "alphabetic";
  const wide = context.measureText(text).width, left = Math.max(2, px + 12 + wide > view.width ? px - 12 - wide : px + 12);
  let top = py - 10;
  while (taken.some(([x, y]) => Math.abs(x - px) < 70 && Math.abs(y - top) < 15)) top -= 16;
  taken.push([px, top]);
  context.lineWidth = 4; context.strokeStyle = color("map-free"); context.strokeText(text, left, top);
  context.fillStyle = color("ink"); context.fillText(text, left, top);
}

/** The robot at {x, y, heading}, with its footprint where it is known. */
export function draw_robot(context, view, {x, y, heading}, footprint) {
  const [px, py] = view.at(x, y);
  context.save(); context.translate(px, py); context.rotate(-heading);
  context.fillStyle = color("focus"); context.strokeStyle = color("ink"); context.lineWidth = 1.5;
  if (footprint) {
    context.beginPath();
    if (footprint.polygon_m) footprint.polygon_m.forEach(([fx, fy]) => context.lineTo(fx * view.scale, -fy * view.scale));
    else context.arc(0, 0, Math.max(3, (footprint.radius_m || 0.2) * view.scale), 0, 7);
    context.closePath(); context.globalAlpha = 0.45; context.fill(); context.globalAlpha = 1; context.stroke();
  }
  const r = Math.max(footprint ? 8 : 13, ((footprint && footprint.radius_m) || 0.25) * view.scale * 0.8);
  context.beginPath(); context.moveTo(r, 0); context.lineTo(-0.5 * r, 0.55 * r); context.lineTo(-0.2 * r, 0); context.lineTo(-0.5 * r, -0.55 * r); context.closePath(); context.fill(); context.stroke();
  context.restore();
}

export function draw_cross(context, view, x, y) {
  const [px, py] = view.at(x, y);
  context.strokeStyle = color("limit"); context.lineWidth = 4;
  context.beginPath(); context.arc(px, py, 16, 0, 7); context.moveTo(px - 10, py - 10); context.lineTo(px + 10, py + 10); context.moveTo(px + 10, py - 10); context.lineTo(px - 10, py + 10); context.stroke();
}

export function draw_scale(context, view) {
  const wish = 110 / view.scale, power = 10 ** Math.floor(Math.log10(wish)), length = [1, 2, 5, 10].map((m) => m * power).filter((m) => m <= wish).pop();
  const bottom = view.height - 12;
  context.fillStyle = color("map-free"); context.globalAlpha = 0.85; context.fillRect(8, bottom - 20, length * view.scale + 16, 26); context.globalAlpha = 1;
  context.strokeStyle = context.fillStyle = color("ink"); context.lineWidth = 2; context.font = "12px system-ui, sans-serif"; context.textAlign = "left"; context.textBaseline = "alphabetic";
  context.beginPath(); context.moveTo(16, bottom); context.lineTo(16 + length * view.scale, bottom); context.stroke();
  context.fillText(Number(length.toPrecision(1)) + " m", 16, bottom - 5);
}

/** Row of the way that is nearest to a place on the canvas, within `reach_px`; else -1. */
export function nearest_row(view, x, y, px, py, reach_px = 22) {
  let best = -1, least = reach_px ** 2;
  for (let k = 0; k < x.length; ++k) {
    const [qx, qy] = view.at(x[k], y[k]), d = (qx - px) ** 2 + (qy - py) ** 2;
    if (d < least) { least = d; best = k; }
  }
  return best;
}
