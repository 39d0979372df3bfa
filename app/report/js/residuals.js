/** Prediction less measurement against what the motion was, over all runs: what a missing effect depends on. */
import {h, key} from "page/dom.js";
import {plot} from "page/plot.js";
import {split_key} from "page/numbers.js";
import {color} from "page/theme.js";
import {jp} from "report/core.js";

const kVariables = ["motion_speed_m_s", "motion_acceleration_m_s2", "motion_yaw_rate_rad_s", "motion_payload_kg"];
const kSignals = ["motor_power_W", "battery_power_W", "motor_current_left_A", "motor_voltage_left_V"];
const kBins = 15, kFewestSamples = 5;
const kLooks = [["predicted", "second"], ["corrected", "plan"]];

/** Mean differences in equal bins of a variable: [{x, predicted, corrected}]. */
function binned(runs, signal, variable) {
  let low = Infinity, high = -Infinity;
  for (const {columns} of runs) for (const x of columns[variable] || []) { low = Math.min(low, x); high = Math.max(high, x); }
  if (!(high - low > 1e-9)) return [];
  const bins = Array.from({length: kBins}, (_, k) => ({x: low + (k + 0.5) * (high - low) / kBins, count: 0, predicted: 0, corrected: 0}));
  for (const {columns} of runs) {
    const measured = columns["measured_" + signal];
    if (!measured || !columns[variable]) continue;
    columns[variable].forEach((x, k) => {
      const bin = bins[Math.min(kBins - 1, Math.floor((x - low) / (high - low) * kBins))];
      bin.count += 1;
      for (const [look] of kLooks) bin[look] += columns[`${look}_${signal}`] ? columns[`${look}_${signal}`][k] - measured[k] : NaN;
    });
  }
  return bins.filter((bin) => bin.count >= kFewestSamples).map((bin) => ({x: bin.x, predicted: bin.predicted / bin.count, corrected: bin.corrected / bin.count}));
}

jp.residuals_section = function (data) {
  const runs = (data.runs || []).filter((run) => run.columns && run.columns.time_s);
  const signal = kSignals.find((name) => runs.some((run) => run.columns["measured_" + name]));
  if (!signal) return null;
  const {words: what, unit} = split_key(signal), of_signal = runs.filter((run) => run.columns["measured_" + signal]);
  const plots = kVariables.map((variable) => [split_key(variable), binned(of_signal, signal, variable)]).filter(([, bins]) => bins.length > 1).map(([name, bins]) => {
    const looks = kLooks.filter(([look]) => bins.some((bin) => Number.isFinite(bin[look])));
    const lines = () => looks.map(([look, ink]) => ({xs: bins.map((bin) => bin.x), ys: bins.map((bin) => bin[look]), stroke: color(ink), dots: 2.5}));
    const axis = name.words.replace(/^motion /, "");
    return plot({title: `against ${axis}`, unit, keys: looks.map(([look, ink]) => key(look, `var(--${ink})`)), point: () => {},
      content: () => ({lines: lines(), fitted: true, limits: [0], label: `${axis} in ${name.unit}`})});
  });
  if (!plots.length) return null;
  jp.redraws.push(() => plots.forEach((one) => one.draw()));
  return jp.section("What is left depends on", h("p", {class: "soft"}, `Mean of model less measured ${what} over all runs. A flat line at 0 means that nothing is left to explain.`),
    h("div", {class: "plots"}, plots.map((one) => one.element)));
};
