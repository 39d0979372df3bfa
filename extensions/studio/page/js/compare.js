/** Plan A beside the plan, and the classic profiles on the same ways. */
import {button, h, key} from "page/dom.js";
import {number, signed, words} from "page/numbers.js";
import {ask} from "studio/answers.js";
import {emit, on, store} from "studio/store.js";
import {causes_of} from "studio/summary.js";

/** Keeps the plan as A; the next plans are shown against it. */
export function ab_panel() {
  const body = h("div");
  const keep = button("Keep this plan as A", () => { store.kept = {answer: store.answer}; emit("view"); }, {id: "keep"});
  const drop = button("Forget A", () => { store.kept = null; emit("view"); });
  const show = () => {
    keep.disabled = !store.answer;
    drop.disabled = !store.kept;
    if (!store.kept || !store.answer) { body.replaceChildren(h("p", {class: "soft small"}, "Keep a plan as A, then change payload, path, robot or time, or keep a classic profile as A: figures, plots and causes show the difference.")); return; }
    const a = store.kept.answer.plan, b = store.answer.plan, of = causes_of(a);
    const row = (name, x, y, digits = 5) => h("tr", {}, h("th", {scope: "row"}, name), h("td", {class: "n"}, number(x, digits)), h("td", {class: "n"}, number(y, digits)), h("td", {class: "n"}, signed(y - x)));
    body.replaceChildren(h("table", {}, h("caption", {class: "small"}, `Plan A${store.kept.name ? ", " + store.kept.name : ""} (dashed gray), and plan B (now)`), h("thead", {}, h("tr", {}, ["", "A", "B", "B − A"].map((text, k) => h("th", {scope: "col", class: k ? "n" : null}, text || h("span", {class: "unseen"}, "figure"))))),
      h("tbody", {}, row("energy, J", a.energy_J, b.energy_J, 6), row("time, s", a.duration_s, b.duration_s), row("distance, m", a.distance_m, b.distance_m), causes_of(b).map((cause) => row(words(cause.name) + ", J", (of.find((one) => one.name === cause.name) || {value: 0}).value, cause.value)))));
  };
  on("answer", show);
  on("view", show);
  show();
  return [h("div", {class: "tools"}, keep, drop), body];
}

const kColors = ["second", "third", "fifth", "fourth", "sixth", "limit", "soft"], kDashes = [[5, 3], [2, 2]];
export function classics_panel() {
  const body = h("div");
  const keep = (classic) => { store.kept = {name: words(classic.name), answer: {motion: classic.motion, plan: {...store.answer.plan, ...classic}}}; emit("view"); };
  const load = button("Compare with classic profiles", async () => {
    load.disabled = true;
    body.replaceChildren(h("p", {class: "soft small"}, "driving the same ways by trapezoids, S-curves, least time …"));
    const edits = store.edits, answer = await ask("classics", {samples: 300});
    load.disabled = false;
    if (answer.superseded) return;
    if (answer.error || !answer.classics) { body.replaceChildren(h("p", {class: "bad"}, answer.error ? answer.error.message : "no plan to compare with")); return; }
    if (edits !== store.edits) return;
    store.classics = answer.classics.map((classic, k) => ({...classic, color: kColors[k % kColors.length], dash: kDashes[Math.floor(k / kColors.length) % kDashes.length], shown: k === 0}));
    emit("view");
  });
  const show = () => {
    if (!store.classics) { body.replaceChildren(h("p", {class: "soft small"}, "Each on the same path in the same time. A later one is compared with the least energy in its own time.")); return; }
    const plan = store.answer.plan;
    body.replaceChildren(h("table", {}, h("caption", {class: "unseen"}, "Classic profiles"), h("thead", {}, h("tr", {}, ["profile", "J", "more", "s later"].map((text, k) => h("th", {scope: "col", class: k ? "n" : null}, text)), h("th", {scope: "col"}, h("span", {class: "unseen"}, "plan A")))),
      h("tbody", {}, store.classics.map((classic, k) => h("tr", {}, h("td", {}, classic.feasible ? h("label", {}, h("input", {type: "checkbox", checked: classic.shown, onchange: (event) => { classic.shown = event.target.checked; emit("view"); }, id: "classic" + k}), " ", key(words(classic.name), `var(--${classic.color})`, classic.dash)) : words(classic.name)),
        classic.feasible ? [h("td", {class: "n"}, number(classic.energy_J, 5)), h("td", {class: "n"}, `${number(100 * (classic.energy_J / classic.optimum_J - 1), 2)} %`), h("td", {class: "n"}, classic.later_s > 1e-3 ? number(classic.later_s, 3) : "–"), h("td", {}, button("A", () => keep(classic), {class: "link", "aria-label": `keep ${words(classic.name)} as plan A`}))]
          : h("td", {colspan: 4, class: "soft small"}, classic.reason))))));
  };
  on("view", show);
  on("edit", show);
  on("answer", show);
  show();
  return [h("div", {class: "tools"}, load), body];
}
