/** The energy-time front of the mission as a curve: the duration is dragged along it. */
import {button, h, sharp} from "page/dom.js";
import {is_number, number, short, ticks, value_at} from "page/numbers.js";
import {ask} from "studio/answers.js";
import {set_value} from "studio/editing.js";
import {on, store} from "studio/store.js";
import {color, on_theme} from "page/theme.js";

const kLeft = 50, kRight = 10, kTop = 10, kBottom = 34;

export function front_panel() {
  const canvas = h("canvas", {role: "img", "aria-label": "Least energy for each duration"});
  const slider = h("input", {type: "range", id: "front-time", min: 0, max: 1000, value: 0, "aria-label": "Duration of the mission in seconds", disabled: true});
  const text = h("p", {class: "small soft"}, "");
  const compute = button("Compute the front", load);
  const box = h("div", {class: "front", hidden: true}, canvas);
  slider.hidden = true;
  let frame = null, dragging = false;

  async function load() {
    compute.disabled = true;
    text.textContent = "computing …";
    const edits = store.edits, answer = await ask("front", {points: 16, samples: 2});
    compute.disabled = false;
    if (answer.superseded) return;
    if (answer.error || !answer.front || !answer.front.length) { text.textContent = answer.error ? answer.error.message : "no front"; return; }
    if (edits !== store.edits) return;
    store.front = kept = answer.front;
    show();
  }

  /** The deadline refers to the end of the mission; beyond the cheapest time it does not bind. */
  function put(time_s, release) {
    const points = curve(), low = points[0].duration_s, value = Math.max(low * 1.0002 + 1e-3, time_s);
    set_value("mission", ["objective", "deadline_s"], Number(value.toFixed(2)), {of: "front", release});
  }
  let kept = null;
  const curve = () => store.front || kept || [];

  function show() {
    const points = curve();
    slider.disabled = !points.length;
    box.hidden = slider.hidden = !points.length;
    compute.textContent = store.front ? "Compute again" : "Compute the front";
    if (!canvas.isConnected || !canvas.parentElement.clientWidth) return;
    const {context, width, height} = sharp(canvas, 190);
    context.clearRect(0, 0, width, height);
    if (!points.length || !store.answer) return;
    const xs = points.map((p) => p.duration_s), ys = points.map((p) => p.energy_J), plan = store.answer.plan;
    const x0 = xs[0], x1 = Math.max(xs.at(-1), plan.duration_s), classics = (store.classics || []).filter((one) => one.feasible && one.duration_s < x1 + 1e-3);
    const drawn_J = [...ys, plan.energy_J, ...classics.map((one) => one.energy_J)], low = Math.min(...drawn_J), high = Math.max(...drawn_J), pad = 0.08 * (high - low) || 1;
    const X = (x) => kLeft + (width - kLeft - kRight) * (x - x0) / Math.max(1e-9, x1 - x0), Y = (y) => kTop + (height - kTop - kBottom) * (high + pad - y) / (high - low + 2 * pad);
    frame = {back: (px) => x0 + (px - kLeft) * (x1 - x0) / (width - kLeft - kRight), x0, x1};
    context.font = "11px system-ui, sans-serif"; context.fillStyle = color("soft"); context.strokeStyle = color("grid"); context.textAlign = "right"; context.textBaseline = "middle";
    for (const tick of ticks(low, high, 4)) { context.beginPath(); context.moveTo(kLeft, Y(tick)); context.lineTo(width - kRight, Y(tick)); context.stroke(); context.fillText(short(tick, 5), kLeft - 5, Y(tick)); }
    context.textAlign = "center"; context.textBaseline = "top";
    for (const tick of ticks(x0, x1, 4)) context.fillText(short(tick, 5), X(tick), height - kBottom + 4);
    context.fillText("duration, s — energy, J", width / 2, height - 14);
    context.strokeStyle = color("plan"); context.lineWidth = 2; context.setLineDash(store.front ? [] : [5, 4]);
    context.beginPath(); xs.forEach((x, k) => context.lineTo(X(x), Y(ys[k]))); context.stroke(); context.setLineDash([]);
    for (const classic of classics) mark(context, X(classic.duration_s), Y(classic.energy_J), color(classic.color), 4);
    if (store.kept) mark(context, X(store.kept.answer.plan.duration_s), Y(store.kept.answer.plan.energy_J), color("soft"), 5);
    mark(context, X(plan.duration_s), Y(plan.energy_J), color("focus"), 7);
    slider.value = Math.round(1000 * (plan.duration_s - x0) / Math.max(1e-9, x1 - x0));
    slider.setAttribute("aria-valuetext", `${number(plan.duration_s, 4)} s, ${number(plan.energy_J, 5)} J`);
    const price = value_at(xs, points.map((p) => (is_number(p.price_of_time_W) ? p.price_of_time_W : points[1] ? points[1].price_of_time_W : 0)), plan.duration_s);
    text.textContent = `${number(plan.energy_J, 5)} J in ${number(plan.duration_s, 4)} s; price of a second ${number(Math.max(0, price), 3)} W. Drag the dot.` + (store.front ? "" : " The curve is that of the mission before the last change.");
  }
  function mark(context, x, y, fill, r) { context.beginPath(); context.arc(x, y, r, 0, 7); context.fillStyle = fill; context.fill(); context.strokeStyle = color("ground"); context.lineWidth = 1.5; context.stroke(); }

  const pointed = (event, release) => { if (frame && curve().length) put(frame.back(event.clientX - canvas.getBoundingClientRect().left), release); };
  canvas.addEventListener("pointerdown", (event) => { dragging = true; canvas.setPointerCapture(event.pointerId); pointed(event, false); });
  canvas.addEventListener("pointermove", (event) => { if (dragging) pointed(event, false); });
  canvas.addEventListener("pointerup", (event) => { if (dragging) pointed(event, true); dragging = false; });
  slider.addEventListener("input", () => put(frame.x0 + (frame.x1 - frame.x0) * slider.value / 1000, false));
  slider.addEventListener("change", () => put(frame.x0 + (frame.x1 - frame.x0) * slider.value / 1000, true));
  on("answer", show);
  on("view", show);
  on_theme(show);
  window.addEventListener("resize", show);
  return [h("div", {class: "tools"}, compute), box, slider, text];
}
