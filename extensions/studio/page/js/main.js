/** The studio's page. */
import {announce, button, h} from "page/dom.js";
import {section} from "studio/section.js";
import {can_redo, can_undo, on, once, redo, store, undo} from "studio/store.js";
import * as answers from "studio/answers.js";
import {canvas, draw, show_all, view} from "studio/floor_view.js";
import {handles} from "studio/handles.js";
import "studio/pointing.js";
import {plots_panel} from "studio/plots.js";
import {timeline} from "studio/timeline.js";
import {causes, collides, drag_text, leg_list, status_text, tiles} from "studio/summary.js";
import {fields_of} from "studio/fields.js";
import {selection_panel} from "studio/selection.js";
import {front_panel} from "studio/front.js";
import {diagnosis_panel} from "studio/diagnosis.js";
import {ab_panel, classics_panel} from "studio/compare.js";
import {file_tools, page_text} from "studio/share.js";
import {listen} from "studio/keys.js";
import {toggle_theme} from "page/theme.js";

function top_bar() {
  const status = h("span", {class: "badge", id: "status"}), problem = h("p", {class: "problem", role: "alert"});
  const back = button("Undo", undo, {id: "undo"}), again = button("Redo", redo, {id: "redo"}), {buttons, told} = file_tools();
  const show = () => {
    status.textContent = status_text();
    status.className = "badge" + (store.problem || (collides() && !store.working) ? " bad" : store.state === "planned" && !store.working ? "" : " soft-badge");
    if (store.state === "planned" && !store.working && !store.problem && !collides()) status.textContent = store.answer.plan.status;
    problem.textContent = store.problem;
    back.disabled = !can_undo();
    again.disabled = !can_redo();
    document.documentElement.dataset.plan = store.answer ? "shown" : "none";
    document.documentElement.dataset.state = store.working ? "working" : store.problem ? "problem" : store.state;
  };
  ["edit", "answer", "working", "settled", "files"].forEach((event) => on(event, show));
  on("settled", () => announce(store.problem || `${status_text() || "planned"}: ${document.getElementById("energy").textContent}`));
  show();
  return h("header", {class: "top"}, h("h1", {}, store.files.name), status, h("div", {class: "tools"}, back, again, ...buttons, button("Light / dark", toggle_theme, {id: "theme"})), told, problem);
}

function map_tools() {
  const by = (name, text) => button(text, (event) => {
    view.by = name;
    for (const other of event.target.parentElement.children) other.setAttribute("aria-pressed", String(other === event.target));
    draw();
  }, {"aria-pressed": String(view.by === name)});
  const zoom = (factor) => () => { view.zoom(factor, view.width / 2, view.height / 2); draw(); };
  return h("div", {class: "tools map-tools"}, h("div", {role: "group", "aria-label": "Color of the way"}, by("limit", "Active limit"), by("speed", "Speed")),
    h("div", {role: "group", "aria-label": "Zoom"}, button("+", zoom(1.3), {"aria-label": "zoom in"}), button("−", zoom(0.77), {"aria-label": "zoom out"}), button("All", () => { show_all(); draw(); })));
}

/** Sliders of the robot file; rebuilt when a value changes elsewhere (undo, reload). */
function robot_panel() {
  const groups = h("div");
  let shown = "";
  const build = () => {
    shown = JSON.stringify(store.robot);
    groups.replaceChildren(...Object.entries(store.robot).filter(([key, value]) => value && typeof value === "object" && !key.startsWith("uncertainty") && key !== "effects").map(([key, value]) => {
      const fields = fields_of("robot", value, [key]);
      return fields.length ? h("details", {open: key === "limits"}, h("summary", {}, h("h3", {}, key)), h("div", {class: "fields"}, fields)) : null;
    }).filter(Boolean));
  };
  on("edit", ({release}) => { if (release && !groups.contains(document.activeElement) && shown !== JSON.stringify(store.robot)) build(); });
  build();
  return groups;
}

function start() {
  document.title = [store.files.name, store.robot.name, `joulepath studio ${store.version_of_program || ""}`.trim()].filter(Boolean).join(" · ");
  const offline = !store.served ? h("p", {class: "soft small"}, answers.has_core() ? "Without the program no new routes are searched: ways follow their stops, and drawn paths can be edited." : "This page was written by a build without WebAssembly: it shows the plan and cannot change it.") : null;
  const diagnosis = diagnosis_panel();
  document.getElementById("app").replaceChildren(top_bar(),
    h("main", {class: "studio"},
      h("section", {class: "floor", "aria-label": "Floor"}, h("div", {class: "floor-box"}, canvas, map_tools()), timeline(), offline),
      h("div", {class: "figures"}, tiles(), plots_panel(), diagnosis.view),
      h("aside", {class: "panel", id: "panel", "aria-label": "Panel", tabindex: "-1"},
        section("Legs", "legs", leg_list()), section("Chosen", "chosen", selection_panel()), section("Energy by cause", "causes", causes()),
        section("Energy and time", "front", front_panel()), section("Two plans", "ab", ab_panel()), section("Classic profiles", "classics", classics_panel()), section("Robot", "robot", robot_panel()), section("Diagnosis", "diagnosis", diagnosis.panel))),
    h("footer", {}, `joulepath ${store.version_of_program || ""} studio. Keys on the map: N and P choose, arrows move, [ and ] turn, Delete removes, + and − zoom; Ctrl+Z, Ctrl+Y, Ctrl+S.`));
  listen();
  on("settled", () => { document.documentElement.dataset.ready = "true"; });
  new ResizeObserver(draw).observe(canvas.parentElement);
  diagnosis.start();
  answers.start();
  draw();
}
// What tests and benchmarks look at.
window.studio = {store, answers, view, handles, page_text, drag_text, next_draft: () => new Promise((resolve) => once("drafted", () => requestAnimationFrame(resolve)))};
const asked = location.hash.slice(1);
if (asked === "dark" || asked === "light") document.documentElement.dataset.theme = asked;
start();
