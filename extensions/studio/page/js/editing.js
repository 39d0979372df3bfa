/** Changes of a mission, one function each; places in the map's frame. */
import {change, select, store} from "studio/store.js";
import {spline_chain, waypoints_of} from "studio/spline.js";

const kGrid_m = 1e-4;
const rounded = (value) => Math.round(value / kGrid_m) * kGrid_m;
const tidy = (value) => Number(rounded(value).toFixed(4));
const angle = (value) => Number(Math.atan2(Math.sin(value), Math.cos(value)).toFixed(4));

export const legs = () => store.mission.legs || [];

/** The pose in which leg k begins, as last planned. */
function start_of(k) {
  const at = store.answer && store.answer.legs[k] && store.answer.legs[k].start;
  return at ? {x_m: at[0], y_m: at[1], heading_rad: at[2]} : start_pose();
}
export function start_pose() {
  const start = store.mission.start || {};
  const place = start.station ? (store.mission.stations || {})[start.station] || {} : start;
  return {x_m: place.x_m || 0, y_m: place.y_m || 0, heading_rad: start.heading_rad ?? place.heading_rad ?? 0};
}

/** Control points of leg k in the map's frame: curves of four [x, y]. */
export function curves_of(k) {
  const path = legs()[k].path;
  if (path.frame === "map") return path.bezier_m;
  const {x_m, y_m, heading_rad} = start_of(k), c = Math.cos(heading_rad), s = Math.sin(heading_rad);
  return path.bezier_m.map((curve) => curve.map(([x, y]) => [x_m + c * x - s * y, y_m + s * x + c * y]));
}
function set_curves(k, curves) {
  const path = legs()[k].path;
  if (path.frame !== "map") {
    const {x_m, y_m, heading_rad} = start_of(k), c = Math.cos(heading_rad), s = Math.sin(heading_rad);
    curves = curves.map((curve) => curve.map(([x, y]) => [c * (x - x_m) + s * (y - y_m), -s * (x - x_m) + c * (y - y_m)]));
  }
  path.bezier_m = curves.map((curve) => curve.map(([x, y]) => [Number(x.toFixed(6)), Number(y.toFixed(6))]));
}

const heading_at_end = (curves) => { const [, , before, end] = curves.at(-1); return Math.atan2(end[1] - before[1], end[0] - before[0]); };

/**
 * The robot begins leg k at {x_m, y_m, heading_rad}, turned by turn_rad: a path drawn in the map is taken along with its
 * first point, and its first handle turns as much. Paths drawn from the robot pass their new ends on.
 */
function carry(k, pose, turn_rad = 0) {
  for (; legs()[k] && legs()[k].path; ++k) {
    const {path} = legs()[k];
    if (path.frame === "map") return begin_at(k, path.bezier_m, pose, turn_rad);
    if (pose.heading_rad === undefined) return;
    pose = end_of(path.bezier_m, pose);
  }
}
function begin_at(k, curves, {x_m, y_m}, turn_rad) {
  const moved = curves.map((curve) => curve.map((point) => [...point])), [first] = moved;
  const [dx, dy] = [0, 1].map((a) => first[1][a] - first[0][a]), c = Math.cos(turn_rad), s = Math.sin(turn_rad);
  first[0] = [x_m, y_m];
  first[1] = [x_m + c * dx - s * dy, y_m + s * dx + c * dy];
  set_curves(k, moved.length > 1 ? smooth(moved) : moved);
}
/** Where a path drawn from the robot's pose ends. */
function end_of(curves, {x_m, y_m, heading_rad}) {
  const [x, y] = curves.at(-1)[3], c = Math.cos(heading_rad), s = Math.sin(heading_rad);
  return {x_m: x_m + c * x - s * y, y_m: y_m + s * x + c * y, heading_rad: heading_rad + heading_at_end(curves)};
}
/** A chain through its joints with its first and last handle. */
function smooth(curves) {
  const points = waypoints_of(curves), last = curves.at(-1);
  return spline_chain(points, [0, 1].map((a) => curves[0][1][a] - points[0][a]), [0, 1].map((a) => last[3][a] - last[2][a]));
}

export function move_station(name, x_m, y_m, gesture) {
  const x = tidy(x_m), y = tidy(y_m);
  change(() => {
    Object.assign(store.mission.stations[name], {x_m: x, y_m: y});
    if ((store.mission.start || {}).station === name) carry(0, start_pose());
    legs().forEach((leg, k) => { if (leg.to === name) carry(k + 1, {x_m: x, y_m: y}); });
  }, gesture);
}
export function turn_station(name, heading_rad, gesture) {
  change(() => {
    if (heading_rad === null) delete store.mission.stations[name].heading_rad;
    else store.mission.stations[name].heading_rad = angle(heading_rad);
  }, gesture);
}
export function move_start(x_m, y_m, gesture) {
  const name = (store.mission.start || {}).station;
  if (name) return move_station(name, x_m, y_m, gesture);
  change(() => {
    store.mission.start = {...store.mission.start, x_m: tidy(x_m), y_m: tidy(y_m)};
    carry(0, start_pose());
  }, gesture);
}
export function turn_start(heading_rad, gesture) {
  const start = store.mission.start || {};
  if (start.station && start.heading_rad === undefined) return turn_station(start.station, heading_rad, gesture);
  change(() => {
    const before_rad = start_pose().heading_rad;
    store.mission.start = {...(start.station ? {} : {x_m: 0, y_m: 0}), ...start, heading_rad: angle(heading_rad)};
    carry(0, start_pose(), start_pose().heading_rad - before_rad);
  }, gesture);
}

/** Moves control point `point` of curve `curve` of leg k. A chain stays smooth: its joints are waypoints of a spline. */
export function move_handle(k, curve, point, x, y, gesture) {
  change(() => {
    const curves = curves_of(k).map((one) => one.map((p) => [...p]));
    const last = curves.length - 1, heading_before = heading_at_end(curves);
    if (point === 0 && curve === 0) return;
    // The handle before an end moves with it.
    if (point === 3 && curve === last) curves[curve][2] = [0, 1].map((a) => curves[curve][2][a] + [x, y][a] - curves[curve][3][a]);
    curves[curve][point] = [x, y];
    set_curves(k, curves.length > 1 ? smooth(curves) : curves);
    const heading_rad = heading_at_end(curves);
    if (curve === last && point > 1) carry(k + 1, {x_m: curves[last][3][0], y_m: curves[last][3][1], heading_rad}, heading_rad - heading_before);
  }, gesture);
}

/** Turns a leg to a station into a drawn path through waypoints of its present way. */
export function draw_by_hand(k) {
  const motion = store.answer.motion, rows = motion.leg.map((leg, row) => [leg, row]).filter(([leg]) => leg === k).map(([, row]) => row);
  const s = rows.map((row) => motion.arc_length_m[row]), length = s.at(-1);
  const count = Math.max(2, Math.min(9, Math.round(length / 3) + 1));
  const at = (distance) => rows[Math.max(0, s.findIndex((value) => value >= distance - 1e-9))];
  const first = rows.findIndex((row, i) => i + 1 < rows.length && s[i + 1] > 1e-6), points = [];
  for (let i = 0; i < count; ++i) { const row = at(length * i / (count - 1)); points.push([motion.position_x_m[row], motion.position_y_m[row]]); }
  const heading = (row) => [Math.cos(motion.heading_rad[row]), Math.sin(motion.heading_rad[row])];
  const moving = rows.filter((row) => motion.linear_speed_m_s[row] > 1e-3);
  const reach = length / (count - 1) / 3;
  const leave = heading(moving[0] ?? rows[Math.max(0, first)]).map((v) => v * reach), arrive = heading(moving.at(-1) ?? rows.at(-1)).map((v) => v * reach);
  change(() => {
    const {to, ...rest} = legs()[k];
    legs()[k] = {path: {bezier_m: [], frame: "map"}, ...rest};
    set_curves(k, spline_chain(points, leave, arrive));
    store.ways[k] = null;
  });
  select({kind: "leg", leg: k});
}

/** A waypoint in the middle of the longest curve of a path. */
export function add_waypoint(k) {
  change(() => {
    const curves = curves_of(k), points = waypoints_of(curves);
    const span = (c) => Math.hypot(c[3][0] - c[0][0], c[3][1] - c[0][1]);
    const longest = curves.reduce((best, c, i) => (span(c) > span(curves[best]) ? i : best), 0), c = curves[longest];
    points.splice(longest + 1, 0, [0, 1].map((axis) => (c[0][axis] + 3 * c[1][axis] + 3 * c[2][axis] + c[3][axis]) / 8));
    const last = curves.at(-1);
    const half = (p, q, from) => [0, 1].map((axis) => (q[axis] - p[axis]) * (from ? 0.5 : 1));
    set_curves(k, spline_chain(points, half(curves[0][0], curves[0][1], longest === 0), half(last[2], last[3], longest === curves.length - 1)));
  });
}
export function remove_waypoint(k, joint) {
  change(() => {
    const curves = curves_of(k), points = waypoints_of(curves), last = curves.at(-1);
    points.splice(joint, 1);
    set_curves(k, spline_chain(points, [0, 1].map((a) => curves[0][1][a] - curves[0][0][a]), [0, 1].map((a) => last[3][a] - last[2][a])));
  });
}

export const straight = (from, to) => {
  const length = Math.max(0.02, Math.hypot(to.x_m - from.x_m, to.y_m - from.y_m));
  return [{reverse: false, segments: [{arc: [from.x_m, from.y_m, Math.atan2(to.y_m - from.y_m, to.x_m - from.x_m), length, 0, 0]}]}];
};
/** Where leg k ends; -1: the start. */
export const place_after = (k) => {
  const leg = legs()[k];
  if (!leg) return start_pose();
  if (leg.to) return store.mission.stations[leg.to];
  const motion = store.answer && store.answer.motion, row = motion ? motion.leg.lastIndexOf(k) : -1;
  return row >= 0 ? {x_m: motion.position_x_m[row], y_m: motion.position_y_m[row]} : start_pose();
};

/** A new stop behind leg k (-1: before all), at a place of the map. */
export function add_stop(k, x_m, y_m) {
  const stations = store.mission.stations || {};
  let number = 1;
  while (stations["stop_" + number]) ++number;
  const name = "stop_" + number, payload = (legs()[k] || legs()[0] || {}).payload_kg;
  change(() => {
    store.mission.stations = {...stations, [name]: {x_m: tidy(x_m), y_m: tidy(y_m)}};
    legs().splice(k + 1, 0, {to: name, payload_kg: typeof payload === "number" ? payload : 0});
    store.ways.splice(k + 1, 0, straight(place_after(k), {x_m, y_m}));
    if (legs()[k + 2] && legs()[k + 2].to) store.ways[k + 2] = straight({x_m, y_m}, place_after(k + 2));
  });
  select({kind: "station", name});
}
export function remove_leg(k) {
  if (legs().length < 2) return;
  change(() => {
    legs().splice(k, 1);
    store.ways.splice(k, 1);
    if (legs()[k] && legs()[k].to) store.ways[k] = straight(place_after(k - 1), place_after(k));
  });
  select({kind: "none"});
}
/** Exchanges leg k with the one before (-1) or after it (+1). */
export function reorder(k, by) {
  const j = k + by;
  if (j < 0 || j >= legs().length) return;
  change(() => {
    [legs()[k], legs()[j]] = [legs()[j], legs()[k]];
    for (let i = Math.min(k, j); i <= Math.max(k, j) + 1 && i < legs().length; ++i)
      if (legs()[i].to) store.ways[i] = straight(place_after(i - 1), place_after(i)); else store.ways[i] = null;
  });
  select({kind: "leg", leg: j});
}

/** A value at a path of keys: set_value("robot", ["limits", "speed_m_s"], 1.2). undefined removes it. */
export function set_value(file, path, value, gesture) {
  change(() => {
    let place = store[file];
    for (const key of path.slice(0, -1)) place = place[key] = place[key] ?? {};
    if (value === undefined) delete place[path.at(-1)]; else place[path.at(-1)] = value;
  }, gesture);
}
