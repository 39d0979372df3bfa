/* The report of `joulepath diagnose`. Data: {diagnosis, runs: [{name, use, time_s, measured_power_W, predicted_power_W, corrected_power_W}], map, title}. */

const kVerdicts = {
  no_gap: ["No gap", "Calibration errors and noise explain the runs.", true],
  explained: ["Explained", "The causes below explain the gap.", true],
  partly_explained: ["Partly explained", "The causes below explain a part of the gap. The rest is not in the catalog.", false],
  unexplained: ["Unexplained", "No effect of the catalog fits the gap.", false],
  ambiguous: ["Ambiguous", "These runs cannot separate the effects of the group below.", false],
  data_suspect: ["Suspect data", "Channels of the log contradict physics. Repair the dataset first.", false],
  too_little_data: ["Too little data", "The report shows the location of the gap and candidates, but names no cause.", false],
};

jp.cause_name = (cause) => jp.words(cause.effect) + (cause.parameters && cause.parameters.side ? ` (${cause.parameters.side.value})` : "");

/** One card for each named cause with its sizes, and for each unknown one. */
jp.cause_cards = function (d) {
  const line = (text) => jp.h("div", {}, text);
  const interval = (entry) => (entry.interval_95 ? ` (95 %: ${jp.number(entry.interval_95[0])} to ${jp.number(entry.interval_95[1])})` : "");
  const card = (cause) => jp.tile(jp.cause_name(cause), jp.is_number(cause.energy_share) ? jp.fraction(cause.energy_share, 3) + " of the gap" : "–", [
    ...Object.entries(cause.parameters || {}).filter(([key]) => key !== "side").map(([key, entry]) => line(jp.key_value(key, entry.value) + interval(entry))),
    line(`probability ${jp.fraction(cause.probability, 3)}`), line(`closes ${jp.fraction(cause.shrink_fraction_alone, 3)} of the gap alone`),
    (cause.indistinguishable_from || []).length ? line("these runs cannot tell it from " + cause.indistinguishable_from.map(jp.words).join(", ")) : null].filter(Boolean));
  const unknown = (one) => jp.tile("Unknown cause", jp.fraction(one.share, 3) + " of what is explained", [line("depends on " + one.depends_on), line(`probability ${jp.fraction(one.probability, 3)}`)]);
  const cards = [...(d.causes || []).map(card), ...(d.unknowns || []).map(unknown)];
  return cards.length ? jp.h("div", {class: "tiles causes"}, cards) : null;
};

jp.diagnosis_tiles = function (d) {
  const energy = (d.gap || {}).energy || {}, interval = energy.shrink_interval_95;
  return jp.h("div", {class: "tiles"}, [
    jp.tile("Energy gap before", jp.percent(energy.before_percent), jp.is_number(energy.bias_before_percent) ? `bias ${jp.percent(energy.bias_before_percent)} (negative: the model predicts too little)` : jp.with_unit(energy.before_J, "J")),
    !(d.causes || []).length ? jp.tile("After", "–", "nothing is corrected") : jp.is_number(energy.after_percent) ? jp.tile("After the correction", jp.percent(energy.after_percent), jp.with_unit(energy.after_J, "J")) : null,
    jp.is_number(energy.noise_floor_percent) ? jp.tile("Noise floor", jp.percent(energy.noise_floor_percent), "no model gets below it") : null,
    (d.causes || []).length && jp.is_number(energy.shrink_fraction) ? jp.tile("Gap closed", jp.fraction(energy.shrink_fraction), interval ? `95 %: ${jp.fraction(interval[0])} to ${jp.fraction(interval[1])}` : null) : null].filter(Boolean));
};

/** Pairs before_X / after_X of one channel of `gap`, with their noise floor; X carries the unit. */
jp.before_after = function (channel, entry) {
  return Object.keys(entry).flatMap((key) => {
    const found = key.match(/^(.*)before_(.+)$/);
    if (!found || found[1] === "bias_" || (channel === "energy" && found[2] === "J") || !jp.is_number(entry[key])) return [];
    const [, prefix, rest] = found;
    const {words, unit} = jp.split_key("x_" + rest);
    return [{title: jp.words(prefix || (channel === "motion" ? "position" : channel)) + (words.includes("rms") ? " (root mean square)" : ""), unit,
      before: entry[key], after: entry[prefix + "after_" + rest], floor: entry[prefix + "noise_floor_" + rest]}];
  });
};

jp.how_far_section = function (d) {
  const gap = d.gap || {}, blocks = [];
  for (const [channel, entry] of Object.entries(gap)) {
    if (!entry || typeof entry !== "object" || channel === "energy_by_phase") continue;
    for (const pair of jp.before_after(channel, entry)) {
      const row = (label, value, color) => ({label, value, color, text: jp.with_unit(value, pair.unit, 3), marks: jp.is_number(pair.floor) ? [pair.floor] : []});
      blocks.push(jp.h("div", {}, jp.h("h3", {}, pair.title), jp.bar_rows([row("before", pair.before, "var(--second)"), jp.is_number(pair.after) ? row("after", pair.after, "var(--plan)") : null].filter(Boolean)),
        jp.is_number(pair.floor) ? jp.h("p", {class: "soft small"}, `dashed: noise floor ${jp.with_unit(pair.floor, pair.unit, 3)}`) : null));
    }
  }
  const phases = Object.entries(gap.energy_by_phase || {});
  const phase_text = (phase) => `${jp.number(phase.before_J, 3)} → ${jp.with_unit(phase.after_J, "J", 3)}`;
  if (phases.length) blocks.push(jp.h("div", {}, jp.h("h3", {}, "energy by phase, before → after"), jp.bar_rows(phases.map(([name, phase]) => ({label: jp.words(name), value: phase.before_J, text: phase_text(phase), color: "var(--second)", marks: jp.is_number(phase.after_J) ? [phase.after_J] : []}))),
    jp.h("p", {class: "soft small"}, "bar: before, dashed: after")));
  if (!blocks.length) return null;
  const energy = gap.energy || {}, rows = [];
  const share = (label, value, interval, color) => jp.is_number(value) && rows.push({label, value: Math.max(0, value), text: jp.fraction(value), interval, color});
  share("this diagnosis", energy.shrink_fraction, energy.shrink_interval_95, "var(--plan)");
  share("ceiling: the most flexible model", (d.ceiling || {}).shrink_fraction, null, "var(--third)");
  share(`control: ${jp.words((d.control || {}).effect) || "a wrong candidate"}`, (d.control || {}).shrink_fraction, null, "var(--fourth)");
  const validation = d.validation || {};
  return jp.section("How much: the gap before and after", jp.h("p", {class: "soft"}, (validation.method ? `On ${validation.method}` : "On held-out runs") + (validation.runs && validation.runs.length ? `: ${validation.runs.join(", ")}.` : ".")),
    jp.h("div", {class: "columns"}, blocks), rows.length ? [jp.h("h3", {}, "Fraction of the energy gap closed"), jp.bar_rows(rows, {most: 1})] : null);
};

const kMostRows = 10;

/** A floor cell from its entry: bounds given as keys, or as "x0..x1, y0..y1" in the value. */
jp.floor_cell = function (entry) {
  const value = entry.value;
  if (value && typeof value === "object") return {...value, share: entry.share_of_gap};
  if (jp.is_number(entry.x_min_m)) return {...entry, share: entry.share_of_gap};
  const numbers = String(value).match(/-?\d+(\.\d+)?/g);
  if (!numbers || numbers.length !== 4) return null;
  const [x_min_m, x_max_m, y_min_m, y_max_m] = numbers.map(Number);
  return {x_min_m, x_max_m, y_min_m, y_max_m, share: entry.share_of_gap};
};

jp.where_section = function (data) {
  const where = data.diagnosis.where || [];
  if (!where.length) return null;
  const axes = [...new Set(where.map((entry) => entry.axis))];
  const blocks = axes.map((axis) => {
    const every = where.filter((entry) => entry.axis === axis), entries = every.slice().sort((a, b) => (axis === "floor" || axis === "run" ? b.share_of_gap - a.share_of_gap : 0)).slice(0, kMostRows);
    return jp.h("div", {}, jp.h("h3", {}, jp.words(axis)), jp.bar_rows(entries.map((entry) => {
      const cell = axis === "floor" ? jp.floor_cell(entry) : null;
      return {label: cell ? `x ${jp.short(cell.x_min_m, 3)}…${jp.short(cell.x_max_m, 3)}, y ${jp.short(cell.y_min_m, 3)}…${jp.short(cell.y_max_m, 3)} m` : axis === "run" ? String(entry.value) : jp.words(entry.value),
        value: entry.share_of_gap, interval: entry.interval_95, text: (Math.abs(entry.share_of_gap) < 1e-4 ? "< 0.01\u202f%" : jp.fraction(entry.share_of_gap, 3)) + (Math.abs(entry.share_of_gap) >= 1e-4 && jp.is_number(entry.energy_J) ? ` · ${jp.with_unit(entry.energy_J, "J", 3)}` : "") + (jp.is_number(entry.bias_percent) ? ` · bias ${jp.percent(entry.bias_percent)}` : "")};
    }), {most: Math.max(...entries.map((entry) => Math.max(entry.share_of_gap, (entry.interval_95 || [0, 0])[1])), 0.01)}),
    every.length > entries.length ? jp.h("p", {class: "soft small"}, `The largest ${entries.length} of ${every.length}.`) : null);
  });
  const cells = where.filter((entry) => entry.axis === "floor").map(jp.floor_cell).filter(Boolean);
  let map = null;
  if (cells.length) {
    map = jp.floor_map({grid: data.map, cells, label: "Floor map of the gap"});
    const ramp = jp.h("span", {class: "ramp", style: "background:linear-gradient(90deg, transparent, var(--second))"});
    blocks.push(jp.h("div", {}, jp.h("h3", {}, "on the floor"), map.element, jp.h("div", {class: "scale"}, "0", ramp, jp.fraction(Math.max(...cells.map((cell) => cell.share)), 3) + " of the gap")));
  }
  const section = jp.section("Where", jp.h("p", {class: "soft"}, "Shares of the summed absolute power gap, with the expected noise subtracted. The shares of one axis add up to 100 %. Whiskers: 95 % intervals over whole runs. Bias: predicted minus measured, relative to the cell's own energy."), jp.h("div", {class: "columns"}, blocks));
  section.classList.add("long");
  return {section, ready() { if (map) map.draw(); }};
};

jp.which_section = function (d) {
  const causes = d.causes || [], ranking = d.ranking || [];
  const grouped = new Set(causes.flatMap((cause) => (cause.indistinguishable_from || []).length ? [cause.effect, ...cause.indistinguishable_from] : []));
  const named = new Set(causes.map((cause) => cause.effect));
  return jp.section("Which effect", causes.length ? null : jp.h("p", {}, "No cause is named."),
  jp.small_effects(d),
  d.pinned_combination ? jp.h("p", {}, "Determined by the data: " + (typeof d.pinned_combination === "string" ? d.pinned_combination : JSON.stringify(d.pinned_combination))) : null,
  ranking.length ? [jp.h("h3", {}, "Ranking"), jp.bar_rows(ranking.slice(0, 12).map((entry) => ({label: jp.words(entry.effect) + (grouped.has(entry.effect) ? " ◇" : ""), value: entry.probability, text: jp.fraction(entry.probability, 3), color: named.has(entry.effect) ? "var(--plan)" : grouped.has(entry.effect) ? "var(--third)" : "var(--soft)"})), {most: 1}),
    grouped.size ? jp.h("p", {class: "soft small"}, "◇ one group: these runs cannot separate its members.") : null] : null);
};

jp.small_effects = function (d) {
  const small = d.below_materiality || [];
  return small.length ? [jp.h("h3", {}, "Below the materiality floor"), jp.table(["effect", {n: "probability"}, {n: "evidence"}, {n: "size over the floor's"}], small.map((one) => [jp.words(one.effect), {n: jp.fraction(one.probability, 3)}, {n: jp.number(one.evidence, 3)}, {n: jp.number(one.size, 2)}]))] : null;
};

jp.runs_section = function (data) {
  const runs = (data.runs || []).filter((run) => run.time_s && run.time_s.length);
  if (!runs.length) return null;
  const holder = jp.h("div", {});
  let plots = [];
  const show = (index) => {
    const run = runs[index], t = run.time_s;
    const residual = (name) => run[name].map((value, k) => value - run.measured_power_W[k]);
    const cursor = jp.cursor(t.length, (row) => `t ${jp.number(t[row])} s`);
    const with_correction = run.corrected_power_W && run.corrected_power_W.length;
    plots = [jp.plot({title: "Motor power", unit: "W", x: t, x_label: "time, s", cursor, tall: true, series: [{name: "measured", values: run.measured_power_W, color: "soft", width: 1.1}, {name: "predicted", values: run.predicted_power_W, color: "second"},
      ...(with_correction ? [{name: "corrected", values: run.corrected_power_W, color: "plan"}] : [])]}),
    jp.plot({title: "Residual: model minus measured", unit: "W", x: t, x_label: "time, s", cursor, series: [{name: "predicted", values: residual("predicted_power_W"), color: "second"}, ...(with_correction ? [{name: "corrected", values: residual("corrected_power_W"), color: "plan"}] : [])]})];
    holder.replaceChildren(cursor.element, ...plots.map((plot) => plot.element));
    plots.forEach((plot) => plot.draw());
  };
  const choice = jp.h("select", {"aria-label": "Run", onchange: (event) => show(Number(event.target.value))}, runs.map((run, k) => jp.h("option", {value: k}, run.name + (run.use ? ` (${jp.words(run.use)})` : ""))));
  const redraw = () => plots.forEach((plot) => plot.redraw());
  const section = jp.section("Measured against predicted", jp.h("div", {class: "bar-tools"}, jp.h("label", {}, "Run ", choice)), holder);
  section.classList.add("long");
  return {section, ready() { show(0); jp.redraws.push(redraw); window.addEventListener("resize", redraw); }};
};

jp.next_section = function (d) {
  const next = d.next_experiment || {};
  const separates = next.separates || [];
  const {legs, why, ...circumstances} = next.motion || {};
  const text = (one) => Object.entries(one).map(([key, value]) => jp.key_value(key, value)).join(", ");
  const motion = legs ? jp.h("ol", {}, legs.map((leg) => jp.h("li", {}, text(leg)))) : text(circumstances);
  if ((!legs && !motion) || (!separates.length && !next.motion)) return null;
  return jp.section("The next run", separates.length ? jp.h("p", {}, "Separates: " + separates.map((one) => (Array.isArray(one) ? one.map(jp.words).join(" from ") : jp.words(one))).join(", ")) : null,
    why ? jp.h("p", {}, why) : null, jp.h("div", {}, jp.h("b", {}, "Drive: "), legs && jp.is_number(circumstances.payload_kg) ? `with ${jp.short(circumstances.payload_kg)} kg on board` : "", motion), jp.is_number(next.expected_evidence) ? jp.h("p", {class: "soft"}, `Expected evidence ${jp.number(next.expected_evidence, 3)} (log-likelihood between the closest pair).`) : null);
};

jp.caveats_section = function (d) {
  const items = [];
  if (d.leftover && d.leftover.significant) items.push("Left over: " + (d.leftover.description || "a significant rest"));
  const artifacts = (d.artifacts || []).map((artifact) => (typeof artifact === "string" ? artifact : Object.entries(artifact).map(([key, value]) => jp.key_value(key, value)).join(", ")));
  if (artifacts.length) items.push(jp.h("details", {open: artifacts.length < 6}, jp.h("summary", {}, `${artifacts.length} artifact${artifacts.length > 1 ? "s" : ""} in the logs, not fitted as effects`), jp.h("ul", {}, artifacts.map((artifact) => jp.h("li", {}, artifact)))));
  if ((d.missing_channels || []).length) items.push("Missing channels, without which some effects cannot be separated: " + d.missing_channels.map(jp.words).join(", "));
  for (const note of d.notes || []) items.push(note);
  const decisions = d.decisions || {};
  if (decisions.missions) items.push(`In decisions: planning ${decisions.missions} missions with the nominal model loses ${jp.percent(decisions.joules_lost_with_nominal_percent)} of their energy.`);
  return items.length ? jp.section("Notes", jp.h("ul", {}, items.map((item) => jp.h("li", {}, item)))) : null;
};

/** Channels that contradict physics, each with the number that shows it and the line that repairs it. */
jp.suspect_section = function (d) {
  const checks = d.data_checks || [];
  if (!checks.length) return null;
  const rows = checks.map((check) => [check.run === "all" ? "all runs" : check.run, check.channel, jp.words(check.kind), check.evidence, jp.h("code", {}, check.repair || "–")]);
  return jp.section("Suspect channels", jp.h("p", {class: "soft"}, "joulepath check DATASET --repair FILE writes the dataset with these repairs."),
    jp.table(["runs", "channel", "what is wrong", "evidence", "repair in the dataset file"], rows));
};

jp.draw_diagnosis = function (data) {
  const d = data.diagnosis, [words, meaning, good] = kVerdicts[d.verdict] || [jp.words(d.verdict), "", false];
  const where = jp.where_section(data), runs = jp.runs_section(data);
  if (d.verdict === "data_suspect")
    return jp.page(jp.header(data.title || "Diagnosis", d.sentence || meaning, words, good), jp.suspect_section(d), jp.caveats_section(d));
  jp.page(jp.header(data.title || "Diagnosis", d.sentence || meaning, words, good), jp.cause_cards(d), jp.diagnosis_tiles(d), where ? where.section : null, jp.which_section(d),
    jp.how_far_section(d), runs ? runs.section : null, jp.next_section(d), jp.caveats_section(d));
  if (where) where.ready();
  if (runs) runs.ready();
};
