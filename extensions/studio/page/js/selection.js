/** The panel of what is chosen: a stop, a leg, the start; and the mission's own numbers. */
import {button, h} from "page/dom.js";
import {is_number, with_unit} from "page/numbers.js";
import {number_field} from "studio/fields.js";
import {add_stop, add_waypoint, draw_by_hand, legs, remove_leg, set_value, turn_station} from "studio/editing.js";
import {view} from "studio/floor_view.js";
import {has_legs, on, select, store} from "studio/store.js";

const field = (path, label, extra = {}) => {
  const value = path.reduce((at, key) => (at === undefined || at === null ? undefined : at[key]), store.mission);
  return is_number(value) ? number_field({file: "mission", path, value, label, ...extra}) : null;
};
/** A number that may be absent: a button adds it. */
const optional_field = (path, label, start) => field(path, label, {optional: true}) || h("p", {}, button(`Add ${label}`, () => set_value("mission", path, start), {class: "link"}));

function station_fields(name) {
  const place = store.mission.stations[name];
  return [h("h3", {}, `Stop ${name}`), field(["stations", name, "x_m"], "x"), field(["stations", name, "y_m"], "y"),
    place.heading_rad === undefined ? h("p", {}, button("Fix the heading", () => turn_station(name, 0), {class: "link"})) : field(["stations", name, "heading_rad"], "heading", {optional: true}),
    is_number(place.charger_W) ? field(["stations", name, "charger_W"], "charger") : null];
}

function leg_fields(k) {
  const leg = legs()[k];
  if (!leg) return [];
  const payload = typeof leg.payload_kg === "object" ? [field(["legs", k, "payload_kg", "from"], "payload at the start", {unit: "kg"}), field(["legs", k, "payload_kg", "to"], "payload at the end", {unit: "kg"})]
    : [optional_field(["legs", k, "payload_kg"], "payload", 0)];
  const plan = store.answer && store.answer.plan.legs[k];
  return [h("h3", {}, `Leg ${k + 1}: ${leg.to ? "to " + leg.to : leg.path ? "path" : "prescribed motion"}`),
    plan ? h("p", {class: "soft small"}, `${with_unit(plan.energy_J, "J", 5)}, ${with_unit(plan.duration_s, "s")}, ${with_unit(plan.distance_m, "m")}; price of a second ${with_unit(plan.price_of_time_W, "W", 3)}`) : null,
    payload, optional_field(["legs", k, "dwell_s"], "dwell", 10),
    leg.motion ? null : [optional_field(["legs", k, "deadline_s"], "deadline", Math.ceil(plan ? plan.start_s + plan.duration_s : 60)), optional_field(["legs", k, "duration_s"], "duration", Math.ceil(plan ? plan.duration_s : 30))],
    h("div", {class: "tools"}, leg.to ? [button("Edit its stop", () => select({kind: "station", name: leg.to})), store.answer ? button("Draw by hand", () => draw_by_hand(k)) : null] : null,
      leg.path ? button("Add a waypoint", () => add_waypoint(k)) : null,
      store.floor.map ? button("Add a stop behind", () => add_stop(k, view.x_m, view.y_m)) : null,
      button("Remove the leg", () => remove_leg(k), {disabled: legs().length < 2}))];
}

function mission_fields() {
  const objective = store.mission.objective || {}, now = store.answer ? store.answer.plan.duration_s : 60;
  const minimize = h("select", {id: "minimize", onchange: (event) => {
    const value = event.target.value;
    set_value("mission", ["objective"], {...objective, minimize: value, ...(value === "energy_and_time" ? {time_value_W: objective.time_value_W ?? 20} : {time_value_W: undefined})});
  }}, [["energy", "energy"], ["time", "time"], ["energy_and_time", "energy and time"]].map(([value, text]) => h("option", {value, selected: (objective.minimize || "energy") === value}, text)));
  return [h("div", {class: "field"}, h("label", {for: "minimize"}, "minimize"), minimize),
    optional_field(["objective", "deadline_s"], "deadline", Math.ceil(now)),
    objective.minimize === "energy_and_time" ? field(["objective", "time_value_W"], "value of a second") : null,
    optional_field(["start", "battery_fraction"], "battery at the start", 1), optional_field(["clearance_m"], "clearance", 0.05)];
}

/** Rebuilt when the selection or its content changes, not while its sliders move. */
export function selection_panel() {
  const body = h("div", {class: "fields"});
  let shown = "";
  const shape = () => JSON.stringify([store.selection, Object.keys(store.mission.objective || {}), store.mission.objective && store.mission.objective.minimize,
    has_legs() ? legs().map((leg) => Object.keys(leg)) : 0, Object.entries(store.mission.stations || {}).map(([name, place]) => [name, Object.keys(place)]), !!store.answer]);
  const build = () => {
    const {kind, name, leg, of} = store.selection, station = kind === "station" ? name : kind === "heading" && of ? of : null;
    const content = station && (store.mission.stations || {})[station] ? station_fields(station) : (kind === "leg" || kind === "handle") && has_legs() ? leg_fields(leg) : null;
    body.replaceChildren(...(content || [h("p", {class: "soft"}, has_legs() ? "Choose a stop on the map or a leg in the list. Double-click the map to add a stop." : "The planner chooses the order of stops in this mission: stops can be moved, legs cannot be edited.")]).flat(3).filter(Boolean),
      h("h3", {}, "Mission"), ...mission_fields().filter(Boolean));
    shown = shape();
  };
  on("selection", build);
  on("edit", () => body.querySelectorAll(".field").forEach((field) => { if (field.follow) field.follow(); }));
  on("edit", ({release}) => { if (shape() !== shown || (release && !body.contains(document.activeElement))) build(); });
  on("settled", () => { if (!body.contains(document.activeElement)) build(); });
  build();
  return body;
}
