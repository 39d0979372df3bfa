/** Measured against predicted, before and after a correction, for each signal of a chosen run. All numbers are the diagnosis' own. */
import {cursor, row_plot} from "page/cursor.js";
import {button, h} from "page/dom.js";
import {number, split_key, words} from "page/numbers.js";

const kLooks = [["measured", {color: "soft", width: 1.1}], ["predicted", {color: "second"}], ["corrected", {color: "plan"}]];
const kMeasured = "measured_";

/** One plot for each signal: what was measured and predicted, or prediction less measurement. */
function plots_of(columns, shared, as_difference) {
  return Object.keys(columns).filter((name) => name.startsWith(kMeasured)).map((name) => name.slice(kMeasured.length)).map((name) => {
    const {words: title, unit} = split_key(name), measured = columns[kMeasured + name];
    const series = kLooks.filter(([look]) => columns[`${look}_${name}`] && !(as_difference && look === "measured")).map(([look, style]) => {
      const values = columns[`${look}_${name}`];
      return {name: look, values: as_difference ? values.map((value, k) => value - measured[k]) : values, ...style};
    });
    return row_plot({title: as_difference ? `${title}: model less measured` : title, unit, series, x: () => columns.time_s, cursor: shared});
  });
}

/** {element, draw()} for runs [{name, use, columns: {time_s, measured_X, predicted_X, corrected_X}}]. */
export function run_signals(runs) {
  const holder = h("div", {}), choice = h("select", {onchange: show}, runs.map((run, k) => h("option", {value: k}, run.name + (run.use ? ` (${words(run.use)})` : ""))));
  let shared = null, as_difference = false;
  const ways = [["Signals", false], ["Model less measured", true]].map(([text, value]) => button(text, () => { as_difference = value; show(); }, {"data-difference": String(value)}));
  function show() {
    const {columns} = runs[Number(choice.value) || 0], t = columns.time_s;
    shared = cursor(t.length, (row) => `t ${number(t[row])} s`);
    const plots = plots_of(columns, shared, as_difference);
    ways.forEach((way) => way.setAttribute("aria-pressed", String(way.dataset.difference === String(as_difference))));
    holder.replaceChildren(shared.element, h("div", {class: "plots"}, plots.map((one) => one.element)));
    shared.draw();
  }
  show();
  return {element: h("div", {class: "run-signals"}, h("div", {class: "tools"}, h("label", {}, "Run ", choice), h("div", {class: "tools", role: "group", "aria-label": "What is drawn"}, ways)), holder),
    draw: () => shared.draw()};
}
