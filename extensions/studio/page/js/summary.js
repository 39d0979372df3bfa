/** What the plan takes: figures, joules by cause, legs. */
import {button, h} from "page/dom.js";
import {fraction, number, short, signed, with_unit, words} from "page/numbers.js";
import {has_legs, on, select, store} from "studio/store.js";
import {legs, remove_leg, reorder} from "studio/editing.js";

const kStates = {draft: "draft", certified: "certified on these ways", planned: "", none: "planning"};

/** Status in words: quality of the plan and extent of its certificate. */
export const collides = () => !!store.answer && store.answer.legs.some((leg) => leg.blocked);
export function status_text() {
  if (store.problem) return store.verdict && store.verdict.infeasibility ? "infeasible" : "no plan";
  if (store.working) return store.working + " …";
  if (collides()) return "collides";
  return kStates[store.state] || words(store.verdict ? store.verdict.status : "planning");
}

const tile = (what, id) => { const value = h("div", {class: "value", id}), more = h("div", {class: "more"}); return {element: h("div", {class: "tile"}, h("div", {class: "what"}, what), value, more), value, more}; };

/** What changed since a drag began. */
export function drag_text() {
  const {drag, answer} = store;
  if (!drag || !answer || answer.plan === drag.from) return "";
  const by = (key, unit, digits) => `${signed(answer.plan[key] - drag.from[key], digits)}\u202f${unit}`;
  return collides() ? "collides" : `${by("energy_J", "J", 3)}, ${by("duration_s", "s", 3)}`;
}

export function tiles() {
  const energy = tile("Energy", "energy"), time = tile("Time", "time"), price = tile("Price of a second", "price"), battery = tile("Battery at the end", "battery"), gap = tile("Gap on these paths", "gap");
  const show = () => {
    if (!store.answer) return;
    const plan = store.answer.plan, kept = store.kept && store.kept.answer.plan, draft = store.state === "draft";
    energy.value.textContent = with_unit(plan.energy_J, "J", 6);
    energy.more.textContent = kept ? `${signed(plan.energy_J - kept.energy_J)} J against A` : `motion ${with_unit(plan.motion_energy_J, "J", 5)}`;
    time.value.textContent = with_unit(plan.duration_s, "s", 5);
    time.more.textContent = kept ? `${signed(plan.duration_s - kept.duration_s)} s against A` : `${with_unit(plan.distance_m, "m")}`;
    const prices = plan.legs.map((leg) => leg.price_of_time_W).filter((value) => value > 1e-6);
    price.value.textContent = prices.length ? with_unit(Math.max(...prices), "W", 3) : "0 W";
    price.more.textContent = prices.length ? "energy that one more second saves" : "no deadline is active";
    const end = plan.battery && plan.battery.end_fraction;
    battery.value.textContent = fraction(end, 4);
    const missions = plan.battery && plan.battery.missions_per_charge;
    battery.more.textContent = !plan.battery ? "no capacity in the robot file"
      : missions === null ? "the mission draws nothing" : `${short(Math.floor(missions), 7)} missions per charge`;
    gap.value.textContent = draft ? "–" : with_unit(plan.optimality_gap_percent, "%", 2);
    gap.more.textContent = draft ? `drafts have no bound${plan.bound_without_jerk ? " and no jerk limit" : ""}` : `bound${plan.bound_without_jerk ? " without jerk" : ""} ${with_unit(plan.lower_bound_J, "J", 6)}`;
  };
  on("answer", show);
  on("view", show);
  const all = h("div", {class: "tiles", "aria-live": "off"}, [energy, time, price, battery, gap].map((one) => one.element));
  on("answer", () => all.classList.toggle("dimmed", collides()));
  return all;
}

const kCauses = [["coulomb_friction", "plan"], ["viscous_friction", "sixth"], ["copper", "second"], ["not_recovered", "fifth"], ["kinetic", "third"], ["standby", "soft"]];
export const causes_of = (plan) => {
  const cause = plan.energy_by_cause_J;
  return [...kCauses.map(([name, color]) => ({name, color, value: cause[name]})), ...Object.entries(cause.effects || {}).map(([name, value]) => ({name, color: "fourth", value}))];
};

export function causes() {
  const body = h("tbody"), head = h("tr");
  const show = () => {
    if (!store.answer) return;
    const rows = causes_of(store.answer.plan), kept = store.kept && causes_of(store.kept.answer.plan), most = Math.max(1e-9, ...rows.map((row) => Math.abs(row.value)));
    head.replaceChildren(h("th", {scope: "col"}, "cause"), h("th", {scope: "col", class: "n"}, "J"), h("th", {scope: "col"}, h("span", {class: "unseen"}, "share")), ...(kept ? [h("th", {scope: "col", class: "n"}, "against A")] : []));
    body.replaceChildren(...rows.filter((row) => Math.abs(row.value) > 1e-6 * most || row.name === "standby").map((row) => h("tr", {}, h("th", {scope: "row"}, words(row.name)), h("td", {class: "n"}, number(row.value, 5)),
      h("td", {class: "bar"}, h("span", {style: `width:${(100 * Math.abs(row.value) / most).toFixed(1)}%;background:var(--${row.color})`})),
      kept ? h("td", {class: "n"}, signed(row.value - ((kept.find((one) => one.name === row.name) || {}).value || 0))) : null)));
  };
  on("answer", show);
  on("view", show);
  return h("table", {class: "causes"}, h("caption", {class: "unseen"}, "Energy by cause"), h("thead", {}, head), body);
}

export function leg_list() {
  const body = h("tbody");
  const show = () => {
    const planned = store.answer ? store.answer.plan.legs : [];
    const names = has_legs() ? legs() : planned;
    body.replaceChildren(...names.map((leg, k) => {
      const plan = planned[k] || {}, blocked = store.answer && store.answer.legs[k] && store.answer.legs[k].blocked;
      const name = leg.to || (leg.path ? "path" : leg.motion ? "motion" : "leg");
      const chosen = store.selection.kind === "leg" && store.selection.leg === k;
      const tools = has_legs() ? h("td", {class: "tools"}, button("↑", () => reorder(k, -1), {"aria-label": `leg ${k + 1} earlier`, disabled: k === 0}), button("↓", () => reorder(k, 1), {"aria-label": `leg ${k + 1} later`, disabled: k + 1 === names.length}),
        button("×", () => remove_leg(k), {"aria-label": `remove leg ${k + 1}`, disabled: names.length < 2})) : h("td");
      return h("tr", {class: chosen ? "chosen" : ""}, h("td", {}, button(`${k + 1} ${name}`, () => select({kind: "leg", leg: k}), {class: "link", "aria-pressed": String(chosen)}), blocked ? h("span", {class: "badge bad", title: blocked.message}, "collides") : null),
        h("td", {class: "n"}, number(plan.energy_J, 4)), h("td", {class: "n"}, number(plan.duration_s, 4)), tools);
    }));
  };
  ["answer", "edit", "selection"].forEach((event) => on(event, show));
  show();
  return h("table", {class: "legs"}, h("caption", {class: "unseen"}, "Legs"), h("thead", {}, h("tr", {}, h("th", {scope: "col"}, "leg"), h("th", {scope: "col", class: "n"}, "J"), h("th", {scope: "col", class: "n"}, "s"), h("th", {scope: "col"}, h("span", {class: "unseen"}, "order")))), body);
}
