/** The report of `joulepath diagnose`. Data: {diagnosis, verdict: {title, meaning, good}, runs: [{name, use, columns}], map, title}. */
import {h} from "page/dom.js";
import {fraction, is_number, number, percent, short, split_key, with_unit, words} from "page/numbers.js";
import {run_signals} from "page/run_signals.js";
import {jp} from "report/core.js";
import "report/bars.js";
import "report/isolability.js";
import "report/map.js";
import "report/plots.js";
import "report/residuals.js";

jp.cause_name = (cause) => words(cause.effect) + (cause.parameters && cause.parameters.side ? ` (${cause.parameters.side.value})` : "");

/** One card for each named cause with its sizes, and for each unknown one. */
jp.cause_cards = function (d) {
  const line = (text) => h("div", {}, text);
  const interval = (entry) => (entry.interval_95 ? ` (95 %: ${number(entry.interval_95[0])} to ${number(entry.interval_95[1])})` : "");
  const several = (d.causes || []).length > 1;
  const card = (cause) => {
    const [strength, ...others] = Object.entries(cause.parameters || {}).filter(([key]) => key !== "side");
    const size = strength ? with_unit(strength[1].value, split_key(strength[0]).unit, 4) : "–";
    return jp.tile(jp.cause_name(cause), size, [
      strength ? line(split_key(strength[0]).words + interval(strength[1])) : null,
      ...others.map(([key, entry]) => line(jp.key_value(key, entry.value) + interval(entry))),
      line(`probability ${fraction(cause.probability, 3)}`), line(`closes ${fraction(cause.shrink_fraction_alone, 3)} of the energy gap alone`),
      several && is_number(cause.energy_share) ? line(`${fraction(cause.energy_share, 3)} of the energy that the causes change`) : null,
      (cause.indistinguishable_from || []).length ? line("these runs cannot tell it from " + cause.indistinguishable_from.map(words).join(", ")) : null].filter(Boolean));
  };
  const unknown = (one) => jp.tile("Unknown cause", fraction(one.share, 3) + " of the explained gap", [line("depends on " + one.depends_on), line(`probability ${fraction(one.probability, 3)}`)]);
  const cards = [...(d.causes || []).map(card), ...(d.unknowns || []).map(unknown)];
  return cards.length ? h("div", {class: "tiles causes"}, cards) : null;
};

jp.diagnosis_tiles = function (d) {
  const {energy = {}, battery_energy: battery} = d.gap || {}, interval = energy.shrink_interval_95, simulator = d.simulator;
  const at_battery = battery && is_number(battery.before_percent) ? jp.tile("At the battery", (d.causes || []).length ? `${percent(battery.before_percent)} → ${percent(battery.after_percent)}` : percent(battery.before_percent), `energy gap at the battery's terminals; noise floor ${percent(battery.noise_floor_percent)}`) : null;
  return h("div", {class: "tiles"}, [
    simulator ? jp.tile("Simulator's energy gap", percent(simulator.gap_percent), [h("div", {}, `bias ${percent(simulator.bias_percent)}, ${simulator.runs} of ${simulator.of_runs} runs`), h("div", {}, simulator.sentence)]) : null,
    jp.tile(battery ? "Motors' energy gap before" : "Energy gap before", percent(energy.before_percent), is_number(energy.bias_before_percent) ? `bias ${percent(energy.bias_before_percent)} (negative: the model predicts too little)` : with_unit(energy.before_J, "J")),
    !(d.causes || []).length ? jp.tile("After", "–", "nothing is corrected") : is_number(energy.after_percent) ? jp.tile("After the correction", percent(energy.after_percent), with_unit(energy.after_J, "J")) : null,
    is_number(energy.noise_floor_percent) ? jp.tile("Noise floor", percent(energy.noise_floor_percent), "scatter of the runs: a model need not get below it") : null,
    (d.causes || []).length && is_number(energy.shrink_fraction) ? jp.tile("Gap closed", fraction(energy.shrink_fraction), interval ? `95 %: ${fraction(interval[0])} to ${fraction(interval[1])}` : null) : null, at_battery].filter(Boolean));
};

/** Pairs before_X / after_X of one channel of `gap`, with their noise floor; X carries the unit. */
jp.before_after = function (channel, entry) {
  return Object.keys(entry).flatMap((key) => {
    const found = key.match(/^(.*)before_(.+)$/);
    if (!found || found[1] === "bias_" || (channel.endsWith("energy") && found[2] === "J") || !is_number(entry[key])) return [];
    const [, prefix, rest] = found;
    const {words: rest_words, unit} = split_key("x_" + rest);
    return [{title: words(prefix || (channel === "motion" ? "position" : channel)) + (rest_words.includes("rms") ? " (root mean square)" : ""), unit,
      before: entry[key], after: entry[prefix + "after_" + rest], floor: entry[prefix + "noise_floor_" + rest]}];
  });
};

jp.how_far_section = function (d) {
  const gap = d.gap || {}, blocks = [];
  for (const [channel, entry] of Object.entries(gap)) {
    if (!entry || typeof entry !== "object" || channel === "energy_by_phase") continue;
    for (const pair of jp.before_after(channel, entry)) {
      const row = (label, value, color) => ({label, value, color, text: with_unit(value, pair.unit, 3), marks: is_number(pair.floor) ? [pair.floor] : []});
      blocks.push(h("div", {}, h("h3", {}, pair.title), jp.bar_rows([row("before", pair.before, "var(--second)"), is_number(pair.after) ? row("after", pair.after, "var(--plan)") : null].filter(Boolean)),
        is_number(pair.floor) ? h("p", {class: "soft small"}, `dashed: noise floor ${with_unit(pair.floor, pair.unit, 3)}`) : null));
    }
  }
  const phases = Object.entries(gap.energy_by_phase || {});
  const phase_text = (phase) => `${number(phase.before_J, 3)} → ${with_unit(phase.after_J, "J", 3)}`;
  if (phases.length) blocks.push(h("div", {}, h("h3", {}, "energy by phase, before → after"), jp.bar_rows(phases.map(([name, phase]) => ({label: words(name), value: phase.before_J, text: phase_text(phase), color: "var(--second)", marks: is_number(phase.after_J) ? [phase.after_J] : []}))),
    h("p", {class: "soft small"}, "bar: before, dashed: after")));
  if (!blocks.length) return null;
  const energy = gap.energy || {}, rows = [];
  const share = (label, value, interval, color) => is_number(value) && rows.push({label, value: Math.max(0, value), text: fraction(value), interval, color});
  share("this diagnosis", energy.shrink_fraction, energy.shrink_interval_95, "var(--plan)");
  share("ceiling: the most flexible model", (d.ceiling || {}).shrink_fraction, null, "var(--third)");
  share(`control: ${words((d.control || {}).effect) || "a wrong candidate"}`, (d.control || {}).shrink_fraction, null, "var(--fourth)");
  const validation = d.validation || {};
  return jp.section("How much: the gap before and after", h("p", {class: "soft"}, (validation.method ? `Validation: ${validation.method}` : "On held-out runs") + (validation.runs && validation.runs.length ? `: ${validation.runs.join(", ")}.` : ".")),
    h("div", {class: "columns"}, blocks), rows.length ? [h("h3", {}, "Fraction of the energy gap closed"), jp.bar_rows(rows, {most: 1})] : null);
};

const kMostRows = 10;
const kLeastShare = 0.01;  // of an axis: smaller cells tell nothing

/** A floor cell from its entry: bounds given as keys, or as "x0..x1, y0..y1" in the value. */
jp.floor_cell = function (entry) {
  const value = entry.value;
  if (value && typeof value === "object") return {...value, share: entry.share_of_gap};
  if (is_number(entry.x_min_m)) return {...entry, share: entry.share_of_gap};
  const numbers = String(value).match(/-?\d+(\.\d+)?/g);
  if (!numbers || numbers.length !== 4) return null;
  const [x_min_m, x_max_m, y_min_m, y_max_m] = numbers.map(Number);
  return {x_min_m, x_max_m, y_min_m, y_max_m, share: entry.share_of_gap};
};

const cell_text = (cell) => `${short(cell.x_min_m, 3)}…${short(cell.x_max_m, 3)}, ${short(cell.y_min_m, 3)}…${short(cell.y_max_m, 3)}`;
const share_text = (entry) => (Math.abs(entry.share_of_gap) < 1e-4 ? "< 0.01\u202f%" : fraction(entry.share_of_gap, 3) + (is_number(entry.energy_J) ? ` · ${with_unit(entry.energy_J, "J", 3)}` : "")) + (is_number(entry.bias_percent) ? ` · bias ${percent(entry.bias_percent)}` : "");

/** Shares of the gap along one axis: phases, speeds, runs, cells of the floor ...; the largest of them. */
jp.axis_block = function (where, axis) {
  const every = where.filter((entry) => entry.axis === axis), by_share = axis === "floor" || axis === "run";
  const telling = every.filter((entry) => entry.share_of_gap >= kLeastShare);
  const entries = (telling.length ? telling : every).sort((a, b) => (by_share ? b.share_of_gap - a.share_of_gap : 0)).slice(0, kMostRows);
  const name = (entry) => { const cell = axis === "floor" ? jp.floor_cell(entry) : null; return cell ? cell_text(cell) : axis === "run" ? String(entry.value) : words(entry.value); };
  return h("div", {}, h("h3", {}, axis === "floor" ? "floor: x, y in m" : words(axis)),
    jp.bar_rows(entries.map((entry) => ({label: name(entry), value: entry.share_of_gap, interval: entry.interval_95, text: share_text(entry)})), {most: Math.max(...entries.map((entry) => Math.max(entry.share_of_gap, (entry.interval_95 || [0, 0])[1])), 0.01)}),
    every.length > entries.length ? h("p", {class: "soft small"}, by_share ? `The largest ${entries.length} of ${every.length}.` : `${entries.length} of ${every.length}; the others have less than ${fraction(kLeastShare)} each.`) : null);
};

jp.where_section = function (data) {
  const where = data.diagnosis.where || [];
  if (!where.length) return null;
  const axes = [...new Set(where.map((entry) => entry.axis))].filter((axis) => axis !== "floor");
  const cells = where.filter((entry) => entry.axis === "floor").map(jp.floor_cell).filter(Boolean);
  const parts = [h("p", {class: "soft"}, "Shares of the summed absolute power gap, with the expected noise subtracted. The shares of one axis add up to 100 %. Whiskers: 95 % intervals over whole runs. Bias: predicted minus measured, relative to the cell's own energy.")];
  if (cells.length) {
    const map = jp.floor_map({grid: data.map, cells, label: "Floor map of the gap"});
    const ramp = h("span", {class: "ramp", style: "background:linear-gradient(90deg, transparent, var(--second))"});
    parts.push(h("div", {class: "columns"}, h("div", {}, h("h3", {}, "on the floor"), map.element, h("div", {class: "scale"}, "0", ramp, fraction(Math.max(...cells.map((cell) => cell.share)), 3) + " of the gap")), jp.axis_block(where, "floor")));
  }
  if (axes.length) parts.push(h("details", {}, h("summary", {}, "Shares by " + axes.map(words).join(", ")), h("div", {class: "columns"}, axes.map((axis) => jp.axis_block(where, axis)))));
  const section = jp.section("Where", parts);
  section.classList.add("long");
  return section;
};

jp.which_section = function (d) {
  const causes = d.causes || [], ranking = d.ranking || [];
  const label = (cause) => cause.effect + (cause.parameters && cause.parameters.side ? ` (${cause.parameters.side.value})` : "");
  const grouped = new Set(causes.flatMap((cause) => (cause.indistinguishable_from || []).length ? [label(cause), ...cause.indistinguishable_from] : []));
  const named = new Set(causes.map(label));
  return jp.section("Which effect", causes.length ? null : h("p", {}, "No cause is named."),
  jp.small_effects(d), jp.correlations(d),
  d.pinned_combination ? h("p", {}, "Determined by the data: " + (typeof d.pinned_combination === "string" ? d.pinned_combination : JSON.stringify(d.pinned_combination))) : null,
  ranking.length ? [h("h3", {}, "Ranking"), jp.bar_rows(ranking.slice(0, 12).map((entry) => ({label: words(entry.effect) + (grouped.has(entry.effect) ? " ◇" : ""), value: entry.probability, text: fraction(entry.probability, 3), color: named.has(entry.effect) ? "var(--plan)" : grouped.has(entry.effect) ? "var(--third)" : "var(--soft)"})), {most: 1}),
    grouped.size ? h("p", {class: "soft small"}, "◇ one group: these runs cannot separate its members.") : null] : null);
};

/** Estimates that depend on each other: what one of them loses, the other may have. */
jp.correlations = function (d) {
  const rows = (d.correlations || []).map((one) => [words(one.parameter), words(one.other), {n: number(one.correlation, 2)}]);
  return rows.length ? [h("h3", {}, "Estimates that depend on each other"), jp.table(["parameter", "other parameter or calibration constant", {n: "correlation"}], rows)] : null;
};

jp.small_effects = function (d) {
  const small = d.below_materiality || [];
  return small.length ? [h("h3", {}, "Below the materiality floor"), jp.table(["effect", {n: "probability"}, {n: "evidence"}, {n: "size over the floor's"}], small.map((one) => [words(one.effect), {n: fraction(one.probability, 3)}, {n: number(one.evidence, 3)}, {n: number(one.size, 2)}]))] : null;
};

jp.runs_section = function (data) {
  const runs = (data.runs || []).filter((run) => run.columns && run.columns.time_s && run.columns.time_s.length);
  if (!runs.length) return null;
  const signals = run_signals(runs), section = jp.section("Measured against predicted", signals.element);
  jp.redraws.push(signals.draw);
  section.classList.add("long");
  return section;
};

jp.next_section = function (d) {
  const next = d.next_experiment || {};
  const separates = next.separates || [];
  const {legs, why, ...circumstances} = next.motion || {};
  const text = (one) => Object.entries(one).map(([key, value]) => jp.key_value(key, value)).join(", ");
  const motion = legs ? h("ol", {}, legs.map((leg) => h("li", {}, text(leg)))) : text(circumstances);
  const step = d.next_step ? h("p", {}, d.next_step) : null;
  if (!legs && !motion) return step && jp.section("What next", step);
  const chance = is_number(next.probability_settled) ? ` It settles the question with a probability of ${fraction(next.probability_settled)} by the model; this number is not calibrated.` : "";
  return jp.section("What next: one more run", step, separates.length ? h("p", {}, "Separates: " + separates.map((one) => (Array.isArray(one) ? one.map(words).join(" from ") : words(one))).join(", ") + "." + chance) : null,
    why ? h("p", {}, why) : null, h("div", {}, h("b", {}, "Drive: "), motion), is_number(next.expected_evidence) ? h("p", {class: "soft"}, `Expected evidence ${number(next.expected_evidence, 3)} (log-likelihood between the closest pair). joulepath experiment writes the run as a mission.`) : null);
};

jp.caveats_section = function (d) {
  const items = [];
  if (d.leftover && d.leftover.significant) items.push("Left over: " + (d.leftover.description || "a significant rest"));
  const artifacts = (d.artifacts || []).map((artifact) => (typeof artifact === "string" ? artifact : Object.entries(artifact).map(([key, value]) => jp.key_value(key, value)).join(", ")));
  if (artifacts.length) items.push(h("details", {open: artifacts.length < 6}, h("summary", {}, `${artifacts.length} artifact${artifacts.length > 1 ? "s" : ""} in the logs, not fitted as effects`), h("ul", {}, artifacts.map((artifact) => h("li", {}, artifact)))));
  if ((d.missing_channels || []).length) items.push("Missing channels, without which some effects cannot be separated: " + d.missing_channels.map(words).join(", "));
  for (const note of d.notes || []) items.push(note);
  const decisions = d.decisions || {};
  if (decisions.missions) items.push(`In decisions: planning ${decisions.missions} missions with the nominal model loses ${percent(decisions.joules_lost_with_nominal_percent)} of their energy.`);
  return items.length ? jp.section("Notes", h("ul", {}, items.map((item) => h("li", {}, item)))) : null;
};

/** Channels that contradict physics, each with the number that shows it and the line that repairs it. */
jp.suspect_section = function (d) {
  const checks = d.data_checks || [];
  if (!checks.length) return null;
  const rows = checks.map((check) => [check.run === "all" ? "all runs" : check.run, check.channel, words(check.kind), check.evidence, h("code", {}, check.repair || "–")]);
  return jp.section("Suspect channels", d.next_step ? h("p", {class: "soft"}, d.next_step) : null,
    jp.table(["runs", "channel", "what is wrong", "evidence", "repair in the dataset file"], rows));
};

jp.draw_diagnosis = function (data) {
  const d = data.diagnosis, verdict = data.verdict || {title: words(d.verdict), meaning: "", good: false};
  const header = jp.header(data.title || "Diagnosis", d.sentence || verdict.meaning, verdict.title, verdict.good);
  if (d.verdict === "data_suspect") return jp.page(header, jp.suspect_section(d), jp.runs_section(data), jp.caveats_section(d));
  jp.page(header, jp.cause_cards(d), jp.diagnosis_tiles(d), jp.next_section(d), jp.runs_section(data), jp.residuals_section(data), jp.how_far_section(d), jp.which_section(d), jp.where_section(data), jp.isolability_section(d), jp.caveats_section(d));
};
