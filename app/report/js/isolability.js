/** What the design of the runs could show and tell apart, before any residual is looked at. */
import {h} from "page/dom.js";
import {fraction, number, words} from "page/numbers.js";
import {jp} from "report/core.js";

const kOpenGroups = 6;

/** A triangle of the effects that are in any pair: the probability of telling a row from a column. */
function matrix(names, pairs) {
  const pair_of = (a, b) => pairs.find((pair) => (pair.effect === a && pair.other === b) || (pair.effect === b && pair.other === a));
  const cell = (a, b) => {
    const pair = pair_of(a, b);
    const text = pair ? String(Math.round(100 * pair.probability_told_apart)) : "·";
    return h("td", {class: "n", title: pair ? `${words(a)} from ${words(b)}: ${fraction(pair.probability_told_apart)}, 2 ln LR ${number(pair.two_ln_likelihood_ratio, 3)}` : null,
      style: pair ? `background:color-mix(in srgb, var(--second) ${Math.round(45 * (1 - pair.probability_told_apart)) + 5}%, transparent)` : null}, text);
  };
  const head = h("tr", {}, h("th", {scope: "col"}, "effect"), names.slice(0, -1).map((name, k) => h("th", {scope: "col", class: "n", title: words(name)}, String(k + 1))));
  const row = (name, k) => h("tr", {}, h("th", {scope: "row"}, `${k + 1} ${words(name)}`), names.slice(0, k).map((other) => cell(name, other)));
  return h("div", {class: "scroll"}, h("table", {class: "matrix"}, h("thead", {}, head), h("tbody", {}, names.map(row))));
}

jp.isolability_section = function (d) {
  const {effects = [], not_seen = [], not_told_apart = [], groups = []} = d.isolability || {};
  if (!effects.length) return null;
  const met = new Set(not_told_apart.flatMap((pair) => [pair.effect, pair.other]));
  const names = effects.map((one) => one.effect).filter((name) => met.has(name));
  const rest = new Set([...not_seen, ...names]);
  const apart = effects.filter((one) => !rest.has(one.effect) && (!one.found || one.probability_seen >= 0.9)).length;
  return jp.section("What these runs can show",
    h("p", {class: "soft"}, "From motions, payloads, channels and noise alone, for effects of their usual size. A pair counts as told apart, and an effect as seen, where nine in ten such datasets would do so."),
    not_seen.length ? h("p", {}, "Not seen: " + not_seen.map(words).join(", ") + ".") : null,
    groups.length ? h("details", {open: groups.length <= kOpenGroups}, h("summary", {}, `Not told apart: ${groups.length} group${groups.length > 1 ? "s" : ""}`), h("ul", {}, groups.map((group) => h("li", {}, group.map(words).join(" or "))))) : h("p", {}, "Each effect that is seen is told apart from each other one."),
    names.length && apart > 0 ? h("p", {}, `Told apart from every other one: ${apart} effects.`) : null,
    names.length ? h("details", {}, h("summary", {}, "Probability that a pair is told apart, in percent"), matrix(names, not_told_apart), h("p", {class: "soft small"}, "·: at least 90 %.")) : null);
};
