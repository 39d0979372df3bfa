/** Handles on the map: start, stops, their headings, joints and control points of drawn paths. */
import {curves_of, legs, move_handle, move_start, move_station, start_pose, turn_start, turn_station} from "studio/editing.js";
import {has_legs, select, store} from "studio/store.js";

const kHeadingReach_m = 0.9;

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const with_choice = (handle) => ({...handle, chosen: same(store.selection, handle.selects)});

function heading_handle(place, heading_rad, of, turn) {
  const x = place.x_m + kHeadingReach_m * Math.cos(heading_rad), y = place.y_m + kHeadingReach_m * Math.sin(heading_rad);
  return with_choice({kind: "heading", x, y, from: [place.x_m, place.y_m], selects: {kind: "heading", of}, name: `heading of ${of || "the start"}`,
    drag: (mx, my, gesture) => turn(Math.atan2(my - place.y_m, mx - place.x_m), gesture)});
}

function station_handles() {
  const list = [];
  for (const [name, place] of Object.entries(store.mission.stations || {})) {
    list.push(with_choice({kind: "station", x: place.x_m, y: place.y_m, text: name, selects: {kind: "station", name}, name: `stop ${name}`, drag: (x, y, gesture) => move_station(name, x, y, gesture)}));
    if (place.heading_rad !== undefined) list.push(heading_handle(place, place.heading_rad, name, (angle, gesture) => turn_station(name, angle, gesture)));
  }
  return list;
}

function start_handles() {
  if ((store.mission.start || {}).station) return [];
  const place = start_pose();
  return [with_choice({kind: "station", x: place.x_m, y: place.y_m, text: "start", selects: {kind: "start"}, name: "start", drag: move_start}),
    heading_handle(place, place.heading_rad, "", turn_start)];
}

function path_handles(k) {
  const curves = curves_of(k), list = [], leg_chosen = store.selection.leg === k;
  const has_name = ([x, y]) => Object.values(store.mission.stations || {}).some((place) => Math.hypot(place.x_m - x, place.y_m - y) < 0.3);
  curves.forEach((curve, c) => {
    const add = (point, kind, from) => list.push(with_choice({kind, x: curve[point][0], y: curve[point][1], from, text: kind === "joint" && c === curves.length - 1 && !has_name(curve[3]) ? `leg ${k + 1}` : "",
      selects: {kind: "handle", leg: k, curve: c, point}, name: `${kind === "joint" ? "waypoint" : "control point"} ${c + 1}.${point} of leg ${k + 1}`,
      drag: (x, y, gesture) => move_handle(k, c, point, x, y, gesture)}));
    add(3, "joint");
    const ends_only = curves.length > 1;
    if (leg_chosen || curves.length === 1) {
      if (!ends_only || c === 0) add(1, "control", curve[0]);
      if (!ends_only || c === curves.length - 1) add(2, "control", curve[3]);
    }
  });
  return list;
}

export function handles() {
  const list = [...start_handles(), ...station_handles()];
  if (has_legs()) legs().forEach((leg, k) => { if (leg.path) list.push(...path_handles(k)); });
  return list;
}

/** The handle nearest to a place on the canvas, within reach of a finger or a mouse. */
export function handle_at(view, px, py, reach_px) {
  let best = null, least = reach_px;
  for (const handle of handles()) {
    const [hx, hy] = view.at(handle.x, handle.y), distance = Math.hypot(hx - px, hy - py) - (handle.kind === "station" ? 3 : 0);
    if (distance < least) { least = distance; best = handle; }
  }
  return best;
}

/** The next handle in their order, for the keyboard. */
export function choose_next(by) {
  const list = handles();
  if (!list.length) return null;
  const now = list.findIndex((handle) => handle.chosen), next = list[(now + by + list.length) % list.length];
  select(next.selects);
  return next;
}
export const chosen = () => handles().find((handle) => handle.chosen);
