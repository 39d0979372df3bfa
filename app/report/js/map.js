/* The floor: occupancy grid, path colored by speed, marks, cells of a gap, and the cursor on it. */

/** Viridis, sampled: readable with every kind of color vision and in gray. */
const kRamp = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
jp.ramp = function (fraction) {
  // The darkest fifth of the palette is not visible on a dark background, the brightest not on a light one.
  const [low, high] = jp.is_dark() ? [0.22, 1] : [0, 0.88];
  const t = (low + (high - low) * Math.min(1, Math.max(0, fraction))) * (kRamp.length - 1);
  const k = Math.min(kRamp.length - 2, Math.floor(t));
  const mixed = kRamp[k].map((from, channel) => Math.round(from + (t - k) * (kRamp[k + 1][channel] - from)));
  return `rgb(${mixed.join(",")})`;
};
jp.ramp_css = () => `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map(jp.ramp).join(",")})`;

/** Run lengths [class, count, class, count ...] from the bottom row up, to an image. */
jp.grid_image = function (grid) {
  const canvas = document.createElement("canvas");
  canvas.width = grid.width; canvas.height = grid.height;
  const context = canvas.getContext("2d");
  const colors = ["map-free", "map-unknown", "map-occupied", "map-keepout"].map((name) => {
    const hex = jp.color(name);
    return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
  });
  const image = context.createImageData(grid.width, grid.height);
  let cell = 0;
  for (let k = 0; k < grid.runs.length; k += 2) {
    const color = colors[grid.runs[k]];
    for (let n = 0; n < grid.runs[k + 1]; ++n, ++cell) {
      const at = 4 * ((grid.height - 1 - Math.floor(cell / grid.width)) * grid.width + (cell % grid.width));
      image.data[at] = color[0]; image.data[at + 1] = color[1]; image.data[at + 2] = color[2]; image.data[at + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
};

/**
 * {grid, x, y, heading, speed, marks: [{x, y, kind, text}], cells: [{x_min_m, .., share}], cursor}
 * A canvas in map coordinates, north up, one scale for both axes.
 */
jp.floor_map = function (options) {
  const {grid, x = [], y = [], heading = [], speed = [], marks = [], cells = [], cursor} = options;
  const canvas = jp.h("canvas", {role: "img", "aria-label": options.label || "Map with the path", tabindex: cursor ? "0" : null});
  const element = jp.h("div", {class: "map"}, canvas);
  let view, image, image_theme, whole = !!options.whole;
  const top_speed = Math.max(1e-9, ...speed.map(Math.abs));

  const bounds = () => {
    const xs = [...x, ...cells.flatMap((cell) => [cell.x_min_m, cell.x_max_m]), ...marks.map((mark) => mark.x)];
    const ys = [...y, ...cells.flatMap((cell) => [cell.y_min_m, cell.y_max_m]), ...marks.map((mark) => mark.y)];
    const min = (values) => values.reduce((a, b) => Math.min(a, b), Infinity), max = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
    if (grid && (whole || !xs.length)) return [grid.origin[0], grid.origin[1], grid.origin[0] + grid.width * grid.resolution_m, grid.origin[1] + grid.height * grid.resolution_m];
    const margin = Math.max(0.6, 0.09 * Math.max(max(xs) - min(xs), max(ys) - min(ys)));
    return [min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin];
  };

  const draw_grid = (context) => {
    if (!grid) return;
    if (image_theme !== jp.is_dark()) { image = jp.grid_image(grid); image_theme = jp.is_dark(); }
    context.save();
    const [ox, oy] = view.at(grid.origin[0], grid.origin[1]);
    context.translate(ox, oy); context.rotate(-grid.origin[2]);
    context.imageSmoothingEnabled = view.scale * grid.resolution_m < 1;
    const w = grid.width * grid.resolution_m * view.scale, h = grid.height * grid.resolution_m * view.scale;
    context.drawImage(image, 0, -h, w, h);
    context.restore();
  };
  const draw_cells = (context) => {
    const most = Math.max(1e-9, ...cells.map((cell) => Math.abs(cell.share)));
    for (const cell of cells) {
      const [left, bottom] = view.at(cell.x_min_m, cell.y_min_m), [right, top] = view.at(cell.x_max_m, cell.y_max_m);
      context.fillStyle = context.strokeStyle = jp.color("second");
      context.lineWidth = 1;
      context.globalAlpha = 0.08 + 0.77 * Math.abs(cell.share) / most;
      context.fillRect(left, top, right - left, bottom - top);
      context.globalAlpha = 1;
      context.strokeRect(left, top, right - left, bottom - top);
      if (right - left > 44) {
        context.fillStyle = jp.color("ink"); context.font = "12px sans-serif"; context.textAlign = "center";
        context.fillText(Math.abs(cell.share) < 1e-3 ? "" : jp.fraction(cell.share, 2), (left + right) / 2, (top + bottom) / 2 + 4);
      }
    }
  };
  const draw_path = (context) => {
    context.lineWidth = 7; context.lineCap = "round"; context.lineJoin = "round";
    context.strokeStyle = jp.color("map-free");
    context.beginPath(); x.forEach((_, k) => context.lineTo(...view.at(x[k], y[k]))); context.stroke();
    context.lineWidth = 4;
    for (let k = 1; k < x.length; ++k) {
      const [ax, ay] = view.at(x[k - 1], y[k - 1]), [bx, by] = view.at(x[k], y[k]);
      context.strokeStyle = jp.ramp(Math.abs((speed[k] + speed[k - 1]) / 2) / top_speed);
      context.beginPath(); context.moveTo(ax, ay); context.lineTo(bx, by); context.stroke();
    }
  };
  const draw_marks = (context) => {
    const label_places = [];
    for (const mark of marks) {
      const [px, py] = view.at(mark.x, mark.y);
      context.lineWidth = 2; context.strokeStyle = jp.color("ink"); context.fillStyle = jp.color("map-free");
      context.beginPath();
      if (mark.kind === "turn") { context.arc(px, py, 8, -0.4, 4.6); context.stroke(); }
      else if (mark.kind === "problem") { context.strokeStyle = jp.color("limit"); context.lineWidth = 3; context.moveTo(px - 8, py - 8); context.lineTo(px + 8, py + 8); context.moveTo(px + 8, py - 8); context.lineTo(px - 8, py + 8); context.stroke(); }
      else { context.rect(px - 5, py - 5, 10, 10); context.fill(); context.stroke(); }
      if (!mark.text) continue;
      context.font = "600 12px sans-serif";
      const left = px + 9 + context.measureText(mark.text).width > view.width ? px - 9 - context.measureText(mark.text).width : px + 9;
      let ty = py - 11;
      while (label_places.some(([lx, ly]) => Math.abs(lx - px) < 70 && Math.abs(ly - ty) < 14)) ty -= 15;
      label_places.push([px, ty]);
      context.textAlign = "left";
      context.lineWidth = 4; context.strokeStyle = jp.color("map-free"); context.strokeText(mark.text, left, ty);
      context.fillStyle = jp.color("ink"); context.fillText(mark.text, left, ty);
    }
  };
  const draw_robot = (context) => {
    const row = cursor ? cursor.row : -1;
    if (row < 0 || row >= x.length) return;
    const [px, py] = view.at(x[row], y[row]);
    context.save(); context.translate(px, py); context.rotate(-heading[row]);
    context.fillStyle = jp.color("focus"); context.strokeStyle = jp.color("ground"); context.lineWidth = 2;
    context.beginPath(); context.moveTo(13, 0); context.lineTo(-9, 9); context.lineTo(-5, 0); context.lineTo(-9, -9); context.closePath();
    context.fill(); context.stroke(); context.restore();
  };
  const draw_scale_bar = (context, width, height) => {
    const wish = 90 / view.scale, power = 10 ** Math.floor(Math.log10(wish));
    const length = [1, 2, 5, 10].map((m) => m * power).filter((m) => m <= wish).pop();
    context.fillStyle = jp.color("map-free"); context.globalAlpha = 0.8; context.fillRect(8, height - 30, length * view.scale + 16, 24); context.globalAlpha = 1;
    context.strokeStyle = context.fillStyle = jp.color("ink"); context.lineWidth = 2; context.textAlign = "left"; context.font = "11px sans-serif";
    context.beginPath(); context.moveTo(16, height - 12); context.lineTo(16 + length * view.scale, height - 12); context.stroke();
    context.fillText(length + " m", 16, height - 17);
  };

  const map = {element, canvas,
    draw() {
      const [x0, y0, x1, y1] = bounds();
      const width = element.clientWidth || 420;
      const height = Math.round(Math.min(640, Math.max(220, width * (y1 - y0) / Math.max(1e-6, x1 - x0))));
      const ratio = Math.max(2, window.devicePixelRatio || 1);
      const scale = Math.min(width / (x1 - x0), height / (y1 - y0));
      const left = (width - scale * (x1 - x0)) / 2, bottom = (height + scale * (y1 - y0)) / 2;
      view = {scale, width, at: (mx, my) => [left + (mx - x0) * scale, bottom - (my - y0) * scale], back: (px, py) => [x0 + (px - left) / scale, y0 + (bottom - py) / scale]};
      canvas.width = width * ratio; canvas.height = height * ratio; canvas.style.height = "auto";
      const context = canvas.getContext("2d");
      context.scale(ratio, ratio);
      context.fillStyle = jp.color(grid ? "map-unknown" : "map-free"); context.fillRect(0, 0, width, height);
      draw_grid(context); draw_cells(context); draw_path(context); draw_marks(context); draw_robot(context); draw_scale_bar(context, width, height);
    },
    show_whole(value) { whole = value; map.draw(); }};
  if (cursor) {
    cursor.follow(() => map.draw());
    canvas.addEventListener("mousemove", (event) => {
      const box = canvas.getBoundingClientRect();
      const [mx, my] = view.back(event.clientX - box.left, event.clientY - box.top);
      let best = -1, least = (25 / view.scale) ** 2;
      x.forEach((_, k) => { const d = (x[k] - mx) ** 2 + (y[k] - my) ** 2; if (d < least) { least = d; best = k; } });
      if (best >= 0) cursor.set(best);
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowRight" && event.key !== "ArrowLeft") return;
      const step = Math.max(1, Math.round(x.length / 100)) * (event.key === "ArrowRight" ? 1 : -1);
      cursor.set(Math.min(x.length - 1, Math.max(0, cursor.row + step)));
      event.preventDefault();
    });
  }
  jp.redraws.push(() => map.draw());
  window.addEventListener("resize", () => map.draw());
  return map;
};
