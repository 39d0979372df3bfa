/** What every report shares: elements, tables, the frame of the page. */
import {h} from "page/dom.js";
import {is_number, short, split_key, words} from "page/numbers.js";
import {on_theme, toggle_theme} from "page/theme.js";

/** What the parts of a report share; tests look at it, too. */
export const jp = Object.assign(window.joulepath, {redraws: [], plots: [], maps: [], data: JSON.parse(document.getElementById("data").textContent)});

jp.key_value = function (key, value, digits = 4) {
  const {words: name, unit} = split_key(key);
  const text = is_number(value) ? short(value, digits) : Array.isArray(value) || (value && typeof value === "object") ? JSON.stringify(value) : String(value);
  return name + " " + text + (unit ? "\u202f" + unit : "");
};

/** Settings of a profile: one set of keys, or one set per stretch. */
jp.settings_text = function (settings) {
  const text = (one) => Object.entries(one || {}).map(([key, value]) => jp.key_value(key, value)).join(", ");
  if (!Array.isArray(settings)) return text(settings);
  if (settings.length === 1) return text(settings[0]);
  if (!settings.some((one) => Object.keys(one).length)) return "";
  return h("details", {}, h("summary", {}, `${settings.length} stretches`), h("ol", {}, settings.map((one) => h("li", {}, text(one)))));
};

jp.redraw = () => jp.redraws.forEach((redraw) => redraw());

jp.tile = (what, value, more) => h("div", {class: "tile"}, h("div", {class: "what"}, what), h("div", {class: "value"}, value),
  more ? h("div", {class: "more"}, more) : null);
jp.section = (title, ...children) => h("section", {"aria-label": title}, h("h2", {}, title), ...children);

/** A table from rows of cells; numbers as {n: text}, elements and strings as they are. */
jp.table = function (heads, rows, caption) {
  const cell = (tag) => (value) => {
    const right = value && typeof value === "object" && "n" in value && !(value instanceof Node);
    return h(tag, {class: right ? "n" : null, scope: tag === "th" ? "col" : null}, right ? value.n : value);
  };
  const table = h("table", {}, caption ? h("caption", {}, caption) : null,
    h("thead", {}, h("tr", {}, heads.map(cell("th")))), h("tbody", {}, rows.map((row) => h("tr", {}, row.map(cell("td"))))));
  const box = h("div", {class: "scroll"}, table);
  jp.redraws.push(() => {  // a table that is wider than the page scrolls by keys, too
    for (const [name, value] of [["tabindex", "0"], ["role", "region"], ["aria-label", caption || heads.map((head) => head.n || head).join(", ")]])
      if (box.scrollWidth > box.clientWidth) box.setAttribute(name, value); else box.removeAttribute(name);
  });
  return box;
};

/** `sentence`: what a manager reads. Under it: robot, day, version. */
jp.header = function (title, sentence, status, is_good) {
  return [h("header", {class: "top"}, h("h1", {}, title), status ? h("span", {class: "badge" + (is_good ? "" : " bad")}, words(status)) : null,
    h("span", {class: "spacer"}), h("button", {type: "button", onclick: toggle_theme, id: "theme"}, "Light / dark")),
  h("p", {class: "soft small"}, jp.data.about || ""), sentence ? h("p", {class: "sentence"}, sentence) : null];
};
jp.footer = () => h("footer", {}, `Written by joulepath ${jp.data.version || ""}. Data: the JSON in this file. `,
  jp.plots.length > 0 ? "Drag in a plot to zoom, double-click or press 0 to see all." : null);

jp.page = (...content) => {
  document.getElementById("report").replaceChildren(...content.flat(9).filter((item) => item !== null && item !== undefined && item !== false), jp.footer());
};

jp.start = function (draw) {
  const asked = () => { const theme = location.hash.slice(1); if (theme === "dark" || theme === "light") document.documentElement.dataset.theme = theme; };
  asked();
  window.addEventListener("hashchange", asked);
  on_theme(jp.redraw);
  window.addEventListener("resize", jp.redraw);
  let before;
  window.addEventListener("beforeprint", () => { before = document.documentElement.dataset.theme; document.documentElement.dataset.theme = "light"; jp.redraw(); });
  window.addEventListener("afterprint", () => { if (before) document.documentElement.dataset.theme = before; else delete document.documentElement.dataset.theme; });
  draw(jp.data);
  jp.redraw();
  document.documentElement.dataset.ready = "true";
};
