/** Mouse, pen and touch on the map: drag a handle, pan, zoom, show a place of the way. */
import {announce} from "page/dom.js";
import {nearest_row} from "page/floor.js";
import {canvas, draw, view} from "studio/floor_view.js";
import {choose_next, chosen, handle_at} from "studio/handles.js";
import {add_stop, legs, remove_leg, remove_waypoint, turn_start, turn_station} from "studio/editing.js";
import {change, has_legs, select, set_cursor, store} from "studio/store.js";

const pointers = new Map();
let dragged = null, pan = null, pinch = null, gestures = 0;

const place = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };

/** Time at which the way passes nearest to a place, where that is near. */
function time_near(px, py) {
  if (!store.answer) return null;
  const m = store.answer.motion;
  const row = nearest_row(view, m.position_x_m, m.position_y_m, px, py);
  return row < 0 ? null : m.time_s[row];
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  const [px, py] = place(event);
  pointers.set(event.pointerId, [px, py]);
  if (pointers.size === 2) { dragged = pan = null; pinch = spread(); return; }
  const handle = handle_at(view, px, py, event.pointerType === "touch" ? 26 : 14);
  if (handle) {
    store.drag = store.answer && {from: store.answer.plan, at: [px, py]};
    dragged = {selects: handle.selects, gesture: "drag" + ++gestures, moved: false, off: [px - view.at(handle.x, handle.y)[0], py - view.at(handle.x, handle.y)[1]]};
    select(handle.selects);
  } else {
    pan = [px, py, false];
  }
});
canvas.addEventListener("pointermove", (event) => {
  const [px, py] = place(event);
  if (pointers.has(event.pointerId)) pointers.set(event.pointerId, [px, py]);
  if (pinch && pointers.size === 2) {
    const now = spread();
    view.zoom(now.width / pinch.width, now.x, now.y);
    view.x_m -= (now.x - pinch.x) / view.scale; view.y_m += (now.y - pinch.y) / view.scale;
    pinch = now;
    draw();
  } else if (dragged) {
    const handle = chosen();
    if (!handle) return;
    dragged.moved = true;
    if (store.drag) store.drag.at = [px, py];
    handle.drag(...view.back(px - dragged.off[0], py - dragged.off[1]), {of: dragged.gesture, release: false});
  } else if (pan) {
    if (Math.hypot(px - pan[0], py - pan[1]) < 3 && !pan[2]) return;
    view.x_m -= (px - pan[0]) / view.scale; view.y_m += (py - pan[1]) / view.scale;
    pan = [px, py, true];
    draw();
  } else {
    canvas.style.cursor = handle_at(view, px, py, 14) ? "grab" : "default";
    const time_s = time_near(px, py);
    if (time_s !== null) set_cursor(time_s);
  }
});
function lift(event) {
  const [px, py] = place(event);
  pointers.delete(event.pointerId);
  if (dragged && dragged.moved) change(() => {}, {of: dragged.gesture, release: true});
  else if (pan && !pan[2]) { const time_s = time_near(px, py); if (time_s !== null) set_cursor(time_s); else select({kind: "none"}); }
  if (pointers.size < 2) pinch = null;
  if (!pointers.size) dragged = pan = store.drag = null;
  draw();
}
canvas.addEventListener("pointerup", lift);
canvas.addEventListener("pointercancel", lift);
function spread() {
  const [[ax, ay], [bx, by]] = [...pointers.values()];
  return {x: (ax + bx) / 2, y: (ay + by) / 2, width: Math.max(10, Math.hypot(ax - bx, ay - by))};
}
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  view.zoom(Math.exp(-event.deltaY * 0.0015), ...place(event));
  draw();
}, {passive: false});
canvas.addEventListener("dblclick", (event) => {
  if (!has_legs() || !store.floor.map) return;
  const k = store.selection.leg ?? legs().length - 1;
  add_stop(k, ...view.back(...place(event)));
});

const kStep_m = 0.05, kTurn_rad = Math.PI / 36;
/** Turns the selected handle if it has a heading. */
function turn(by) {
  const {kind, name, of} = store.selection, station = kind === "station" ? name : kind === "heading" ? of : null;
  if (station) turn_station(station, (store.mission.stations[station].heading_rad || 0) + by, {of: "turn " + station});
  else if (kind === "start" || kind === "heading") turn_start(((store.mission.start || {}).heading_rad || 0) + by, {of: "turn start"});
}
function remove() {
  const {kind, name, leg, curve, point} = store.selection;
  if (kind === "handle" && point === 3 && legs()[leg].path.bezier_m.length > 1) remove_waypoint(leg, curve + 1);
  else if (kind === "leg") remove_leg(leg);
  else if (kind === "station") { const k = legs().findIndex((one) => one.to === name); if (k >= 0) remove_leg(k); }
}
canvas.addEventListener("keydown", (event) => {
  const step = kStep_m * (event.shiftKey ? 10 : 1), arrows = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
  const handle = chosen();
  if (arrows[event.key] && handle) {
    const [dx, dy] = arrows[event.key];
    handle.drag(handle.x + dx, handle.y + dy, {of: "keys " + handle.name});
    announce(`${handle.name}: ${(handle.x + dx).toFixed(2)}, ${(handle.y + dy).toFixed(2)} m`);
  } else if (arrows[event.key]) {
    view.x_m += 40 * Math.sign(arrows[event.key][0]) / view.scale; view.y_m += 40 * Math.sign(arrows[event.key][1]) / view.scale; draw();
  } else if (event.key === "n" || event.key === "p") {
    const next = choose_next(event.key === "n" ? 1 : -1);
    if (next) announce(next.name);
  } else if (event.key === "[" || event.key === "]") turn(event.key === "[" ? kTurn_rad : -kTurn_rad);
  else if (event.key === "+" || event.key === "-") { view.zoom(event.key === "+" ? 1.25 : 0.8, view.width / 2, view.height / 2); draw(); }
  else if (event.key === "Delete" || event.key === "Backspace") remove();
  else if (event.key === "Escape") select({kind: "none"});
  else return;
  event.preventDefault();
});
