/** `joulepath batch`: how many missions, how they ended, how they spread, which are the worst. */
import {h} from "page/dom.js";
import {fraction, is_number, number, percent, short, with_unit, words} from "page/numbers.js";
import {jp} from "report/core.js";
import "report/bars.js";

jp.draw_batch = function (data) {
  const {count, status, total, spread, unsolved, worst} = data.batch;
  const without = Object.entries(status).reduce((sum, [name, n]) => sum + (name === "optimal" || name === "feasible" ? 0 : n), 0);
  const name = (one) => one.name || one.mission || one.file || "";
  const why = (one) => one.message || one.error || (one.infeasibility ? one.infeasibility.message || words(one.infeasibility.constraint) : "");
  const per_meter = (one) => one.energy_J / one.distance_m;
  const shown = worst.slice(0, 15), compared = shown.some((one) => is_number(one.saving_percent)), saving = (cell) => (compared ? [cell] : []), promised = shown.some((one) => is_number(one.kept)), kept = (cell) => (promised ? [cell] : []);
  const histogram = (key, title, unit) => (spread[key] && spread[key].length ? h("div", {}, h("h3", {}, title), jp.histogram(spread[key], unit)) : null);
  const planned = count - without, meters = total.distance_m || 0;
  const sentence = `${short(planned, 9)} of ${short(count, 9)} mission${count === 1 ? "" : "s"} have a plan` + (planned ? `: together ${with_unit(total.energy_Wh || 0, "Wh")} in ${total.duration_s < 3600 ? with_unit(total.duration_s, "s") : with_unit(total.duration_s / 3600, "h", 3)}, ${with_unit(total.energy_J / meters, "J")} per meter.` : ".");
  jp.page(jp.header(data.title || "Batch", sentence, without ? `${without} without a plan` : "all planned", !without),
    h("div", {class: "tiles"}, jp.tile("Missions", short(count, 9), Object.entries(status).map(([one, n]) => `${n} ${words(one)}` + (one === "optimal" ? " on their paths" : "")).join(", ")), jp.tile("Energy", with_unit(total.energy_Wh || 0, "Wh"), with_unit(total.energy_J || 0, "J")),
      jp.tile("Distance", with_unit(total.distance_m || 0, "m")), jp.tile("Time", with_unit(total.duration_s || 0, "s"))),
    jp.section("Distribution", h("div", {class: "columns"}, histogram("energy_J", "Energy of a mission", "J"), histogram("duration_s", "Duration", "s"), histogram("saving_percent", "Saving against the best tuned trapezoid", "%"), histogram("optimality_gap_percent", "Gap on the chosen paths", "%"))),
    unsolved.length ? jp.section("Without a plan", unsolved.length < without ? h("p", {class: "soft"}, `The first ${unsolved.length} of ${without}.`) : null, jp.table(["mission", "status", "why"], unsolved.map((one) => [name(one), words(one.status), why(one)]))) : null,
    shown.length ? jp.section("Worst missions: most energy per meter", jp.table(["mission", {n: "J/m"}, {n: "energy J"}, {n: "distance m"}, {n: "time s"}, ...saving({n: "saving"}), {n: "gap on its path"}, ...kept({n: "promises kept with"})], shown.map((one) => [name(one), {n: number(per_meter(one))}, {n: number(one.energy_J, 5)}, {n: number(one.distance_m)}, {n: number(one.duration_s)}, ...saving({n: percent(one.saving_percent)}), {n: percent(one.optimality_gap_percent, 2)}, ...kept({n: is_number(one.kept) ? fraction(one.kept) : ""})]))) : null);
};
