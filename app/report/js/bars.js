/** Bars as plain elements: they print sharply, a screen reader reads them, and their numbers stay text. */
import {h} from "page/dom.js";
import {is_number, number, signed, with_unit, words} from "page/numbers.js";
import {jp} from "report/core.js";

/** [{label, value, text, interval: [low, high], color, marks: [value]}] on one scale from 0. */
jp.bar_rows = function (rows, options = {}) {
  const most = options.most || Math.max(1e-12, ...rows.flatMap((row) => [row.value || 0, ...(row.interval || []), ...(row.marks || [])]).map(Math.abs));
  const place = (value) => 100 * Math.min(1, Math.max(0, Math.abs(value) / most));
  return h("div", {class: "rows"}, rows.flatMap((row) => [
    h("span", {}, row.label),
    h("span", {class: "track", "aria-hidden": "true"},
      is_number(row.value) && row.value !== 0 ? h("span", {class: "fill", style: `width:${place(row.value)}%;background:${row.color || "var(--plan)"}`}) : null,
      row.interval ? h("span", {class: "whisker", style: `left:${place(Math.max(0, row.interval[0]))}%;width:${Math.max(0, place(row.interval[1]) - place(Math.max(0, row.interval[0])))}%`}) : null,
      (row.marks || []).map((value) => h("span", {class: "mark", style: `left:${place(value)}%`}))),
    h("span", {class: "n"}, row.text)]));
};

/** Values, each against a base of its own: bars of the differences, where bars from zero would all look alike. */
jp.difference_rows = (rows, unit) => jp.bar_rows(rows.map(({label, value, base}) => {
  const more = Math.abs(value - base) > 1e-9 * Math.abs(base) ? value - base : 0;
  return {label, value: more, color: more < 0 ? "var(--third)" : "var(--second)", text: `${with_unit(value, unit, 6)} (${signed(more)})`};
}));

const kCauseColors = {standby: ["#8b949e", "#000"], copper: ["#e69f00", "#000"], coulomb_friction: ["#0072b2", "#fff"], viscous_friction: ["#56b4e9", "#000"],
  kinetic: ["#cc79a7", "#000"], not_recovered: ["#d55e00", "#000"], battery_loss: ["#5f4b8b", "#fff"]};
const kEffectColors = [["#009e73", "#000"], ["#f0e442", "#000"], ["#7f3c8d", "#fff"], ["#80ba5a", "#000"], ["#a5aa99", "#000"], ["#3969ac", "#fff"]];

/** energy_by_cause_J, effects itemized, to [{name, J, color, ink}]. */
jp.causes = function (by_cause) {
  const listed = [];
  for (const [name, value] of Object.entries(by_cause || {})) {
    if (name === "effects" && value && typeof value === "object") {
      Object.entries(value).forEach(([effect, J], k) => listed.push({name: effect, J, is_effect: true, color: kEffectColors[k % kEffectColors.length][0], ink: kEffectColors[k % kEffectColors.length][1]}));
    } else if (is_number(value)) {
      const [color, ink] = kCauseColors[name] || ["#a5aa99", "#000"];
      listed.push({name, J: value, color, ink});
    }
  }
  const most = listed.reduce((most, cause) => Math.max(most, Math.abs(cause.J)), 0);
  listed.forEach((cause) => { if (Math.abs(cause.J) < 1e-6 * most) cause.J = 0; });  // rounding errors
  const order = ["standby", "coulomb_friction", "viscous_friction", "copper", "kinetic", "not_recovered"];
  const place = (cause) => (order.includes(cause.name) ? order.indexOf(cause.name) : order.length);
  return listed.sort((a, b) => place(a) - place(b));
};
/** The longest text of each part that fits, as long as the bar is as wide as it is. */
function fit_texts(parts) {
  for (const {part, texts} of parts) {
    for (const text of texts) {
      part.textContent = text;
      if (part.scrollWidth <= part.clientWidth) break;
    }
  }
}
jp.stacked_bar = function (causes, full_J, unit = "J") {
  const parts = causes.filter((cause) => cause.J > 0).map((cause) => {
    const name = words(cause.name), share = cause.J / full_J;
    return {part: h("span", {style: `width:${100 * share}%;background:${cause.color};color:${cause.ink};${share < 0.02 ? "padding:0" : ""}`, title: `${name}: ${number(cause.J)} ${unit}`}),
      texts: [`${name} ${number(cause.J, 3)}`, number(cause.J, 3), ""], says: `${name} ${number(cause.J)} ${unit}`};
  });
  jp.redraws.push(() => fit_texts(parts));
  return h("div", {class: "stack", role: "img", "aria-label": parts.map((one) => one.says).join(", ")}, parts.map((one) => one.part));
};

/** Counts in equal bins as columns of a bar row chart. */
jp.histogram = function (values, unit, most_bins = 12) {
  const finite = values.filter(is_number), bins = Math.min(most_bins, 2 * Math.ceil(Math.sqrt(finite.length)));
  if (!finite.length) return h("p", {class: "soft"}, "No values.");
  const low = finite.reduce((a, b) => Math.min(a, b)), high = finite.reduce((a, b) => Math.max(a, b));
  if (high === low) return h("p", {}, `All ${finite.length}: ${with_unit(low, unit)}`);
  const width = (high - low) / bins, counts = new Array(bins).fill(0);
  finite.forEach((value) => counts[Math.min(bins - 1, Math.floor((value - low) / width))]++);
  return jp.bar_rows(counts.map((count, k) => ({label: `${number(low + k * width, 3)} to ${number(low + (k + 1) * width, 3)} ${unit}`, value: count, text: String(count)})));
};
