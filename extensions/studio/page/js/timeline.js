/** The clock of the animation: play, a slider, what holds at the cursor. */
import {button, h} from "page/dom.js";
import {number, row_at, value_at, words} from "page/numbers.js";
import {on, set_cursor, store} from "studio/store.js";

const kRate = 8;  // seconds of the mission per second of watching

export function timeline() {
  const slider = h("input", {type: "range", id: "clock", min: 0, max: 1000, step: 1, value: 0, "aria-label": "Time in the mission"});
  const text = h("output", {class: "readout", for: "clock"});
  let playing = false, last = 0;
  const play = button("Play", () => { playing = !playing; last = performance.now(); label(); if (playing) requestAnimationFrame(tick); }, {id: "play"});
  const label = () => { play.textContent = playing ? "Pause" : "Play"; };
  const end = () => (store.answer ? store.answer.motion.time_s.at(-1) : 0);
  function tick(now) {
    if (!playing) return;
    const next = store.cursor_s + kRate * (now - last) / 1000;
    last = now;
    set_cursor(next >= end() ? 0 : next);
    if (next >= end()) { playing = false; label(); } else requestAnimationFrame(tick);
  }
  const show = () => {
    if (!store.answer) return;
    const m = store.answer.motion, t = store.cursor_s, at = (column) => value_at(m.time_s, m[column], t), row = row_at(m.time_s, t);
    const limit = m.limit[row] < 0 ? "no limit binds" : words(store.answer.limits[m.limit[row]]) + " limit";
    slider.value = end() > 0 ? Math.round(1000 * t / end()) : 0;
    text.textContent = `${number(t, 4)} s · leg ${m.leg[row] + 1} · ${number(at("linear_speed_m_s"), 3)} m/s · ${number(at("battery_power_W"), 3)} W · ${number(at("energy_J"), 4)} J · payload ${number(m.payload_kg[row], 3)} kg · ${limit}`;
    slider.setAttribute("aria-valuetext", text.textContent);
  };
  slider.addEventListener("input", () => set_cursor(end() * Number(slider.value) / 1000));
  on("cursor", show);
  on("answer", () => set_cursor(store.cursor_s));
  return h("div", {class: "timeline"}, play, slider, text);
}
