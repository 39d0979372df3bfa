"use strict";
/* Small helpers that every report shares: elements, numbers, theme, page frame. */
const jp = {errors: [], redraws: [], plots: []};
window.joulepath = jp;
window.addEventListener("error", (event) => jp.errors.push(String(event.message)));

jp.data = JSON.parse(document.getElementById("data").textContent);

/** h("p", {class: "soft"}, "text", child): an element; null children are skipped. */
jp.h = function (tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "style") element.style.cssText = value;
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
};

const kIdsGiven = {};
jp.unique_id = (stem) => { kIdsGiven[stem] = (kIdsGiven[stem] || 0) + 1; return kIdsGiven[stem] > 1 ? `${stem}-${kIdsGiven[stem]}` : stem; };

jp.is_number = (value) => typeof value === "number" && isFinite(value);

/** A number with about `digits` significant digits, thin spaces between thousands, a real minus. */
jp.number = function (value, digits = 4) {
  if (!jp.is_number(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size >= 7 || size < -4) return value.toExponential(digits - 1).replace("-", "\u2212");
  const places = Math.max(0, Math.min(digits - 1 - size, 6));
  const [whole, part] = Math.abs(value).toFixed(places).split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+(?!\d))/g, "\u2009") : whole;
  return (value < 0 ? "\u2212" : "") + grouped + (part ? "." + part : "");
};
/** As number(), without zeros at the end: for axes and settings. */
jp.short = (value, digits = 4) => jp.number(value, digits).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
jp.percent = (value, digits = 3) => (jp.is_number(value) ? jp.number(value, digits) + "\u202f%" : "–");
jp.fraction = (value, digits = 3) => jp.percent(jp.is_number(value) ? 100 * value : value, digits);
jp.with_unit = (value, unit, digits) => (jp.is_number(value) ? jp.number(value, digits) + "\u202f" + unit : "–");
jp.words = (name) => String(name ?? "").replace(/_/g, " ");

/** "speed_m_s" -> {words: "speed", unit: "m/s"}: keys carry their unit at the end. */
const kUnits = [["_Nm_s_rad", "N m s/rad"], ["_N_s2_m2", "N s²/m²"], ["_N_s_m", "N s/m"], ["_kg_m2", "kg m²"], ["_rad_s2", "rad/s²"], ["_m_s2", "m/s²"],
  ["_m_s3", "m/s³"], ["_rad_s", "rad/s"], ["_m_s", "m/s"], ["_per_m", "1/m"], ["_percent", "%"], ["_Nm", "N m"], ["_ohm", "Ω"], ["_rad", "rad"],
  ["_Wh", "Wh"], ["_kg", "kg"], ["_m", "m"], ["_s", "s"], ["_J", "J"], ["_W", "W"], ["_V", "V"], ["_A", "A"], ["_C", "°C"]];
jp.split_key = function (key) {
  const entry = kUnits.find(([ending]) => key.endsWith(ending));
  return entry ? {words: jp.words(key.slice(0, -entry[0].length)), unit: entry[1]} : {words: jp.words(key), unit: ""};
};
jp.key_value = function (key, value, digits = 4) {
  const {words, unit} = jp.split_key(key);
  const text = jp.is_number(value) ? jp.short(value, digits) : Array.isArray(value) || (value && typeof value === "object") ? JSON.stringify(value) : String(value);
  return words + " " + text + (unit ? "\u202f" + unit : "");
};

/** Settings of a profile: one set of keys, or one set per stretch. */
jp.settings_text = function (settings) {
  const text = (one) => Object.entries(one || {}).map(([key, value]) => jp.key_value(key, value)).join(", ");
  if (!Array.isArray(settings)) return text(settings);
  if (settings.length === 1) return text(settings[0]);
  if (!settings.some((one) => Object.keys(one).length)) return "";
  return jp.h("details", {}, jp.h("summary", {}, `${settings.length} stretches`), jp.h("ol", {}, settings.map((one) => jp.h("li", {}, text(one)))));
};

jp.color = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
jp.series_colors = () => ["plan", "second", "third", "fourth", "fifth", "sixth"].map(jp.color);
jp.is_dark = () => {
  const asked = document.documentElement.dataset.theme;
  return asked ? asked === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
};
jp.redraw = () => jp.redraws.forEach((redraw) => redraw());
jp.set_theme = function (theme) {
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  jp.redraw();
};

jp.tile = (what, value, more) => jp.h("div", {class: "tile"}, jp.h("div", {class: "what"}, what), jp.h("div", {class: "value"}, value),
  more ? jp.h("div", {class: "more"}, more) : null);
jp.section = (title, ...children) => jp.h("section", {"aria-label": title}, jp.h("h2", {}, title), ...children);
jp.key = (text, color, style = "") => jp.h("span", {class: "key"}, jp.h("i", {class: style, style: style === "box" ? `background:${color}` : `border-color:${color}`}), text);

/** A table from rows of cells; numbers as {n: text}, elements and strings as they are. */
jp.table = function (heads, rows, caption) {
  const cell = (tag) => (value) => {
    const is_number = value && typeof value === "object" && "n" in value && !(value instanceof Node);
    return jp.h(tag, {class: is_number ? "n" : null, scope: tag === "th" ? "col" : null}, is_number ? value.n : value);
  };
  return jp.h("div", {class: "scroll"}, jp.h("table", {}, caption ? jp.h("caption", {}, caption) : null,
    jp.h("thead", {}, jp.h("tr", {}, heads.map(cell("th")))), jp.h("tbody", {}, rows.map((row) => jp.h("tr", {}, row.map(cell("td")))))));
};

jp.header = function (title, subtitle, status, is_good) {
  const cycle = () => jp.set_theme(jp.is_dark() ? "light" : "dark");
  return [jp.h("header", {class: "top"}, jp.h("h1", {}, title), status ? jp.h("span", {class: "badge" + (is_good ? "" : " bad")}, jp.words(status)) : null,
    jp.h("span", {class: "spacer"}), jp.h("button", {type: "button", onclick: cycle, id: "theme"}, "Light / dark")),
  subtitle ? jp.h("p", {class: "soft"}, subtitle) : null];
};
jp.footer = () => jp.h("footer", {}, `Written by joulepath ${jp.data.version || ""}. Data: the JSON in this file. `,
  "Plots: dygraphs 2 (MIT license; the notice is at the top of this file). Drag in a plot to zoom, double-click or press 0 to see all.");

jp.page = (...content) => {
  document.getElementById("report").replaceChildren(...content.flat(9).filter((item) => item !== null && item !== undefined && item !== false), jp.footer());
};

jp.start = function (draw) {
  const asked = location.hash.slice(1);
  if (asked === "dark" || asked === "light") document.documentElement.dataset.theme = asked;
  window.addEventListener("hashchange", () => ["dark", "light"].includes(location.hash.slice(1)) && jp.set_theme(location.hash.slice(1)));
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", jp.redraw);
  let before;
  window.addEventListener("beforeprint", () => { before = document.documentElement.dataset.theme; jp.set_theme("light"); });
  window.addEventListener("afterprint", () => jp.set_theme(before));
  draw(jp.data);
  jp.redraw();
  document.documentElement.dataset.ready = "true";
};
