/* Bars as plain elements: sharp in print, readable by screen readers, with numbers as text. */

/** [{label, value, text, interval: [low, high], color, marks: [value]}] on one scale from 0. */
jp.bar_rows = function (rows, options = {}) {
  const most = options.most || Math.max(1e-12, ...rows.flatMap((row) => [row.value || 0, ...(row.interval || []), ...(row.marks || [])]).map(Math.abs));
  const place = (value) => 100 * Math.min(1, Math.max(0, Math.abs(value) / most));
  return jp.h("div", {class: "rows"}, rows.flatMap((row) => [
    jp.h("span", {}, row.label),
    jp.h("span", {class: "track", "aria-hidden": "true"},
      jp.is_number(row.value) && row.value !== 0 ? jp.h("span", {class: "fill", style: `width:${place(row.value)}%;background:${row.color || "var(--plan)"}`}) : null,
      row.interval ? jp.h("span", {class: "whisker", style: `left:${place(Math.max(0, row.interval[0]))}%;width:${Math.max(0, place(row.interval[1]) - place(Math.max(0, row.interval[0])))}%`}) : null,
      (row.marks || []).map((value) => jp.h("span", {class: "mark", style: `left:${place(value)}%`}))),
    jp.h("span", {class: "n"}, row.text)]));
};

const kCauseColors = {standby: ["#8b949e", "#000"], copper: ["#e69f00", "#000"], coulomb_friction: ["#0072b2", "#fff"], viscous_friction: ["#56b4e9", "#000"],
  kinetic: ["#cc79a7", "#000"], not_recovered: ["#d55e00", "#000"], battery_loss: ["#5f4b8b", "#fff"]};
const kEffectColors = [["#009e73", "#000"], ["#f0e442", "#000"], ["#7f3c8d", "#fff"], ["#80ba5a", "#000"], ["#a5aa99", "#000"], ["#3969ac", "#fff"]];

/** energy_by_cause_J, effects itemized, to [{name, J, color, ink}]. */
jp.causes = function (by_cause) {
  const listed = [];
  for (const [name, value] of Object.entries(by_cause || {})) {
    if (name === "effects" && value && typeof value === "object") {
      Object.entries(value).forEach(([effect, J], k) => listed.push({name: effect, J, is_effect: true, color: kEffectColors[k % kEffectColors.length][0], ink: kEffectColors[k % kEffectColors.length][1]}));
    } else if (jp.is_number(value)) {
      const [color, ink] = kCauseColors[name] || ["#a5aa99", "#000"];
      listed.push({name, J: value, color, ink});
    }
  }
  const most = listed.reduce((most, cause) => Math.max(most, Math.abs(cause.J)), 0);
  listed.forEach((cause) => { if (Math.abs(cause.J) < 1e-9 * most) cause.J = 0; });  // rounding errors
  const order = ["standby", "coulomb_friction", "viscous_friction", "copper", "kinetic", "not_recovered"];
  const place = (cause) => (order.includes(cause.name) ? order.indexOf(cause.name) : order.length);
  return listed.sort((a, b) => place(a) - place(b));
};
jp.stacked_bar = function (causes, full_J, unit = "J") {
  const shown = causes.filter((cause) => cause.J > 0);
  return jp.h("div", {class: "stack", role: "img", "aria-label": shown.map((cause) => `${jp.words(cause.name)} ${jp.number(cause.J)} ${unit}`).join(", ")},
    shown.map((cause) => {
      const share = cause.J / full_J;
      return jp.h("span", {style: `width:${100 * share}%;background:${cause.color};color:${cause.ink};${share < 0.02 ? "padding:0" : ""}`, title: `${jp.words(cause.name)}: ${jp.number(cause.J)} ${unit}`},
        share > 0.012 * (jp.words(cause.name).length + 6) ? `${jp.words(cause.name)} ${jp.number(cause.J, 3)}` : share > 0.07 ? jp.number(cause.J, 3) : "");
    }));
};

/** Counts in equal bins as columns of a bar row chart. */
jp.histogram = function (values, unit, most_bins = 12) {
  const finite = values.filter(jp.is_number), bins = Math.min(most_bins, 2 * Math.ceil(Math.sqrt(finite.length)));
  if (!finite.length) return jp.h("p", {class: "soft"}, "No values.");
  const low = finite.reduce((a, b) => Math.min(a, b)), high = finite.reduce((a, b) => Math.max(a, b));
  if (high === low) return jp.h("p", {}, `All ${finite.length}: ${jp.with_unit(low, unit)}`);
  const width = (high - low) / bins, counts = new Array(bins).fill(0);
  finite.forEach((value) => counts[Math.min(bins - 1, Math.floor((value - low) / width))]++);
  return jp.bar_rows(counts.map((count, k) => ({label: `${jp.number(low + k * width, 3)} to ${jp.number(low + (k + 1) * width, 3)} ${unit}`, value: count, text: String(count)})));
};
