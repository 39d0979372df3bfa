/** A diagnosis beside the plan: measured against predicted for each signal of a chosen run, as its file has them. */
import {button, h} from "page/dom.js";
import {fraction, number, percent, words} from "page/numbers.js";
import {run_signals} from "page/run_signals.js";
import {on_theme} from "page/theme.js";
import {tell} from "studio/share.js";
import {store} from "studio/store.js";

/** What a diagnosis found, in a line. */
function finding(d) {
  const energy = (d.gap || {}).energy || {}, causes = (d.causes || []).map((cause) => `${words(cause.effect)} (${fraction(cause.probability, 3)})`);
  const after = causes.length && typeof energy.after_percent === "number" ? `, ${percent(energy.after_percent)} after the correction` : "";
  const verdict = words(d.verdict), [, title = "", rest = d.sentence || ""] = (d.sentence || "").match(/^([A-Z][^:]*): (.*)$/) || [];  // "No gap above 2 % of the energy: …"
  const more = title.toLowerCase().startsWith(verdict) ? title.slice(verdict.length) : "";
  return [h("p", {}, h("b", {}, verdict + more), rest ? `: ${rest}` : ""), causes.length ? h("p", {class: "small"}, `Causes: ${causes.join(", ")}`) : null,
    typeof energy.before_percent === "number" ? h("p", {class: "small"}, `Energy gap ${percent(energy.before_percent)}${after}, noise floor ${number(energy.noise_floor_percent, 3)}\u202f%`) : null];
}

/** {panel, view}: the button that opens a file, and the plots of what it holds. */
export function diagnosis_panel() {
  const body = h("div"), view = h("section", {"aria-label": "Measured against predicted", hidden: true}), file = h("input", {type: "file", accept: ".json,application/json", hidden: true, id: "diagnosis-file", "aria-label": "diagnosis.json"});
  let signals = null;
  function show(d) {
    const runs = (d.signals || []).filter((run) => run.columns && run.columns.time_s && run.columns.time_s.length);
    body.replaceChildren(...[finding(d), runs.length ? null : h("p", {class: "soft small"}, "This file holds no signals: joulepath diagnose DATASET --signals writes them.")].flat().filter(Boolean));
    signals = runs.length ? run_signals(runs) : null;
    view.hidden = !signals;
    view.replaceChildren(...(signals ? [h("h2", {}, "Measured against predicted"), signals.element] : []));
    if (signals) signals.draw();
  }
  async function open(chosen) {
    if (!chosen) return;
    let d = null;
    try { d = JSON.parse(await chosen.text()); } catch { /* said below */ }
    if (!d || !String(d.schema).startsWith("joulepath/diagnosis/")) return tell(`${chosen.name} is no diagnosis.json of joulepath.`, true);
    store.diagnosis = d;
    show(d);
    tell("Opened " + chosen.name);
  }
  file.addEventListener("change", async () => { await open(file.files[0]); file.value = ""; });  // the same file can be opened again
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => { event.preventDefault(); open(event.dataTransfer.files[0]); });
  const redraw = () => { if (signals) signals.draw(); };
  on_theme(redraw);
  window.addEventListener("resize", redraw);
  body.append(h("p", {class: "soft small"}, "A diagnosis.json with signals shows the measured signals of each run and the predictions of the model, before and after the correction."));
  return {panel: [h("div", {class: "tools"}, button("Open a diagnosis", () => file.click(), {id: "open-diagnosis"}), file), body], view, start() { if (store.diagnosis) show(store.diagnosis); }};
}
