/** The floor of a report: grid, path colored by speed, marks, cells of a gap, and the cursor on it. */
import {h, sharp} from "page/dom.js";
import {box_of, corners_of, draw_cross, draw_picture, draw_robot, draw_scale, draw_text, draw_way, floor_view, nearest_row, picture_of, rgb} from "page/floor.js";
import {fraction} from "page/numbers.js";
import {color, is_dark, ramp} from "page/theme.js";
import {jp} from "report/core.js";

/** Classes of cells as the report's data number them. */
const kClasses = ["map-free", "map-unknown", "map-occupied", "map-keepout"];

function draw_cells(context, view, cells) {
  const most = Math.max(1e-9, ...cells.map((cell) => Math.abs(cell.share)));
  for (const cell of cells) {
    const [left, bottom] = view.at(cell.x_min_m, cell.y_min_m), [right, top] = view.at(cell.x_max_m, cell.y_max_m);
    context.fillStyle = context.strokeStyle = color("second");
    context.lineWidth = 1;
    context.globalAlpha = 0.08 + 0.77 * Math.abs(cell.share) / most;
    context.fillRect(left, top, right - left, bottom - top);
    context.globalAlpha = 1;
    context.strokeRect(left, top, right - left, bottom - top);
    if (right - left > 44 && Math.abs(cell.share) >= 1e-3) {
      context.fillStyle = color("ink"); context.font = "12px sans-serif"; context.textAlign = "center";
      context.fillText(fraction(cell.share, 2), (left + right) / 2, (top + bottom) / 2 + 4);
    }
  }
}

function draw_marks(context, view, marks) {
  const taken = [];
  for (const mark of marks) {
    const [px, py] = view.at(mark.x, mark.y);
    context.lineWidth = 2; context.strokeStyle = color("ink"); context.fillStyle = color("map-free");
    context.beginPath();
    if (mark.kind === "turn") { context.arc(px, py, 8, -0.4, 4.6); context.stroke(); }
    else if (mark.kind === "problem") draw_cross(context, view, mark.x, mark.y);
    else { context.rect(px - 5, py - 5, 10, 10); context.fill(); context.stroke(); }
    if (mark.text) draw_text(context, view, mark.text, px + (mark.kind === "problem" ? 9 : 0), py, taken);  // beside the cross
  }
}

/** {grid, x, y, heading, speed, marks: [{x, y, kind, text}], cells: [{x_min_m, .., share}], cursor, label}: the whole map and all of these
 *  places, in a box of their shape; after show_whole(false) the places alone. */
jp.floor_map = function ({grid, x = [], y = [], heading = [], speed = [], marks = [], cells = [], cursor, label}) {
  const canvas = h("canvas", {role: "img", "aria-label": label || "Map with the path", tabindex: cursor ? "0" : null});
  const element = h("div", {class: "floor-box"}, canvas), view = floor_view();
  const top_speed = speed.reduce((most, v) => Math.max(most, Math.abs(v)), 1e-9), by_speed = (k) => ramp(Math.abs(speed[k] + speed[k - 1]) / 2 / top_speed);
  let picture, picture_dark, whole = true;
  const box = () => {
    const places = [...marks, ...cells.flatMap((cell) => [{x: cell.x_min_m, y: cell.y_min_m}, {x: cell.x_max_m, y: cell.y_max_m}]), ...(grid && whole ? corners_of(grid) : [])];
    return box_of([...x, ...places.map((place) => place.x)], [...y, ...places.map((place) => place.y)]);
  };
  const [x0, y0, x1, y1] = box();
  element.style.aspectRatio = Math.max(1, x1 - x0) / Math.max(1, y1 - y0);
  const map = {element, canvas, view, marks,
    draw() {
      if (!element.clientWidth) return;
      const {context, width, height} = sharp(canvas);
      Object.assign(view, {width, height});
      view.show(...box());
      context.fillStyle = color(grid ? "map-unknown" : "map-free"); context.fillRect(0, 0, width, height);
      if (grid && picture_dark !== is_dark()) {
        const shades = kClasses.map(rgb);
        picture = picture_of([{grid, shade: (cell) => shades[cell]}]);
        picture_dark = is_dark();
      }
      if (grid) draw_picture(context, view, grid, picture);
      draw_cells(context, view, cells);
      draw_way(context, view, x, y, by_speed, speed);
      draw_scale(context, view);
      draw_marks(context, view, marks);
      const row = cursor ? cursor.row : -1;
      if (row >= 0 && row < x.length) draw_robot(context, view, {x: x[row], y: y[row], heading: heading[row]});
    },
    show_whole(value) { whole = value; map.draw(); }};
  if (cursor) follow(cursor, canvas, map, () => view, x, y);
  jp.redraws.push(map.draw);
  jp.maps.push(map);
  return map;
};

/** The map moves the cursor, by pointer and by keys, and follows it. */
function follow(cursor, canvas, map, view, x, y) {
  cursor.follow(map.draw);
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect(), row = nearest_row(view(), x, y, event.clientX - box.left, event.clientY - box.top, 25);
    if (row >= 0) cursor.set(row);
  });
  canvas.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowRight" && event.key !== "ArrowLeft") return;
    const step = Math.max(1, Math.round(x.length / 100)) * (event.key === "ArrowRight" ? 1 : -1);
    cursor.set(Math.min(x.length - 1, Math.max(0, cursor.row + step)));
    event.preventDefault();
  });
}
