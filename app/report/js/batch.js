/* `joulepath batch`: how many missions, how they ended, how they spread, which are the worst. */

jp.draw_batch = function (data) {
  const missions = data.batch.missions || [];
  const solved = missions.filter((one) => one.status === "optimal" || one.status === "feasible");
  const counts = {};
  missions.forEach((one) => { counts[one.status] = (counts[one.status] || 0) + 1; });
  const value = (key) => solved.map((one) => one[key]).filter(jp.is_number);
  const sum = (values) => values.reduce((a, b) => a + b, 0);
  const energy = sum(value("energy_J"));
  const name = (one) => one.name || one.file || one.mission || "";
  const unsolved = missions.filter((one) => !solved.includes(one));
  const per_meter = (one) => one.energy_J / one.distance_m;
  const worst = solved.filter((one) => one.distance_m > 0).sort((a, b) => per_meter(b) - per_meter(a)).slice(0, 15);
  const spread = (key, title, unit) => (value(key).length ? jp.h("div", {}, jp.h("h3", {}, title), jp.histogram(value(key), unit)) : null);
  jp.page(jp.header(data.title || "Batch", data.subtitle || `${missions.length} missions`, unsolved.length ? `${unsolved.length} without a plan` : "all planned", !unsolved.length),
    jp.h("div", {class: "tiles"}, jp.tile("Missions", String(missions.length), Object.entries(counts).map(([status, count]) => `${count} ${jp.words(status)}`).join(", ")), jp.tile("Energy", jp.with_unit(energy / 3600, "Wh"), jp.with_unit(energy, "J")),
      jp.tile("Distance", jp.with_unit(sum(value("distance_m")), "m")), jp.tile("Time", jp.with_unit(sum(value("duration_s")), "s"))),
    jp.section("Distribution", jp.h("div", {class: "columns"}, spread("energy_J", "Energy of a mission", "J"), spread("duration_s", "Duration", "s"), spread("saving_percent", "Saving against the best tuned trapezoid", "%"), spread("optimality_gap_percent", "Optimality gap", "%"))),
    unsolved.length ? jp.section("Without a plan", jp.table(["mission", "status", "why"], unsolved.map((one) => [name(one), jp.words(one.status), one.message || one.error || jp.words((one.infeasibility || {}).constraint || "")]))) : null,
    worst.length ? jp.section("Worst missions: most energy per meter", jp.table(["mission", {n: "J/m"}, {n: "energy J"}, {n: "distance m"}, {n: "time s"}, {n: "saving"}, {n: "gap"}], worst.map((one) => [name(one), {n: jp.number(per_meter(one))}, {n: jp.number(one.energy_J, 5)}, {n: jp.number(one.distance_m)}, {n: jp.number(one.duration_s)}, {n: jp.percent(one.saving_percent)}, {n: jp.percent(one.optimality_gap_percent, 2)}]))) : null);
};
