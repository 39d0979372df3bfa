/* `joulepath batch`: number of missions, their status, their distributions, and the worst missions. */

jp.draw_batch = function (data) {
  const {count, status, total, spread, unsolved, worst} = data.batch;
  const without = Object.entries(status).reduce((sum, [name, n]) => sum + (name === "optimal" || name === "feasible" ? 0 : n), 0);
  const name = (one) => one.name || one.mission || one.file || "";
  const why = (one) => one.message || one.error || (one.infeasibility ? one.infeasibility.message || jp.words(one.infeasibility.constraint) : "");
  const per_meter = (one) => one.energy_J / one.distance_m;
  const shown = worst.slice(0, 15);
  const histogram = (key, title, unit) => (spread[key] && spread[key].length ? jp.h("div", {}, jp.h("h3", {}, title), jp.histogram(spread[key], unit)) : null);
  jp.page(jp.header(data.title || "Batch", data.subtitle || `${jp.short(count, 9)} missions`, without ? `${without} without a plan` : "all planned", !without),
    jp.h("div", {class: "tiles"}, jp.tile("Missions", jp.short(count, 9), Object.entries(status).map(([one, n]) => `${n} ${jp.words(one)}`).join(", ")), jp.tile("Energy", jp.with_unit((total.energy_J || 0) / 3600, "Wh"), jp.with_unit(total.energy_J || 0, "J")),
      jp.tile("Distance", jp.with_unit(total.distance_m || 0, "m")), jp.tile("Time", jp.with_unit(total.duration_s || 0, "s"))),
    jp.section("Distribution", jp.h("div", {class: "columns"}, histogram("energy_J", "Energy of a mission", "J"), histogram("duration_s", "Duration", "s"), histogram("saving_percent", "Saving against the best tuned trapezoid", "%"), histogram("optimality_gap_percent", "Optimality gap", "%"))),
    unsolved.length ? jp.section("Without a plan", unsolved.length < without ? jp.h("p", {class: "soft"}, `The first ${unsolved.length} of ${without}.`) : null, jp.table(["mission", "status", "why"], unsolved.map((one) => [name(one), jp.words(one.status), why(one)]))) : null,
    shown.length ? jp.section("Worst missions: most energy per meter", jp.table(["mission", {n: "J/m"}, {n: "energy J"}, {n: "distance m"}, {n: "time s"}, {n: "saving"}, {n: "gap"}], shown.map((one) => [name(one), {n: jp.number(per_meter(one))}, {n: jp.number(one.energy_J, 5)}, {n: jp.number(one.distance_m)}, {n: jp.number(one.duration_s)}, {n: jp.percent(one.saving_percent)}, {n: jp.percent(one.optimality_gap_percent, 2)}]))) : null);
};
