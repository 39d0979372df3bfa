/** Sliders and number boxes with units and ranges from the JSON Schemas of the files. */
import {h} from "page/dom.js";
import {is_number, short, split_key} from "page/numbers.js";
import {set_value} from "studio/editing.js";
import {store} from "studio/store.js";

/** The schema of a value at a path of keys. */
function schema_at(kind, path) {
  let schema = store.schemas[kind];
  for (const key of path) {
    if (!schema) return null;
    const options = schema.anyOf || [schema];
    const of = (one) => (typeof key === "number" ? one.items : (one.properties && one.properties[key]) || (typeof one.additionalProperties === "object" ? one.additionalProperties : null));
    schema = options.map(of).find(Boolean) || null;
  }
  return schema;
}
const numeric = (schema) => (schema ? (schema.anyOf || [schema]).find((one) => one.type === "number" || one.type === "integer") || {} : {});

/** A round number at or above a value. */
const ceiling = (value) => { const power = 10 ** Math.floor(Math.log10(value)); return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].map((m) => m * power).find((m) => m >= value * 0.9999); };

/** The slider's range: the schema's where it is narrow, else from 0 to three times the value. */
function range_of(schema, value) {
  const low = schema.minimum ?? schema.exclusiveMinimum, high = schema.maximum;
  const reach = ceiling(3 * Math.max(Math.abs(value), 1e-3));
  const min = is_number(low) && Math.abs(low) <= reach ? low : value < 0 ? -reach : low === undefined ? -reach : 0;
  const max = is_number(high) && high <= reach ? high : reach;
  const step = Math.max(10 ** Math.floor(Math.log10(max - min) - 2.3), 1e-6);
  return {min: schema.exclusiveMinimum === min ? min + step : min, max, step};
}

let count = 0;
/** One number of a file: {file, path, value, label, unit, absent}. */
export function number_field({file, path, value, label, unit, says, optional}) {
  const schema = numeric(schema_at(file, path)), id = "field" + ++count, key = split_key(String(path.at(-1)));
  const {min, max, step} = range_of(schema, value), gesture = "field " + file + path.join(".");
  const slider = h("input", {type: "range", min, max, step, value, id: id + "s", "aria-label": `${label || key.words} in ${unit || unit_of(path) || "1"}`, tabindex: "0"});
  const box = h("input", {type: "number", id, step: "any", value: short_number(value), "aria-describedby": says || schema.description ? id + "d" : null});
  const put = (text, release) => {
    const next = Number(text), bound = schema.minimum ?? -Infinity, above = schema.exclusiveMinimum ?? -Infinity;
    const wrong = text === "" || !isFinite(next) || next < bound || next <= above || next > (schema.maximum ?? Infinity);
    box.setAttribute("aria-invalid", String(wrong));
    if (!wrong) set_value(file, path, next, {of: gesture, release});
    return wrong;
  };
  slider.addEventListener("input", () => { box.value = slider.value; put(slider.value, false); });
  slider.addEventListener("change", () => put(slider.value, true));
  box.addEventListener("change", () => { if (!put(box.value, true)) slider.value = box.value; });
  const description = says || schema.description;
  const field = h("div", {class: "field"}, h("label", {for: id}, label || key.words, description ? h("span", {class: "unseen", id: id + "d"}, description) : null), slider, box, h("span", {class: "unit", title: description || null}, unit || unit_of(path)),
    optional ? h("button", {type: "button", class: "link", "aria-label": `remove ${label || key.words}`, onclick: () => set_value(file, path, undefined)}, "×") : null);
  field.follow = () => {  // what changes elsewhere: a drag on the map
    const now = path.reduce((at, one) => (at === undefined || at === null ? undefined : at[one]), store[file]);
    if (!is_number(now) || field.contains(document.activeElement)) return;
    slider.value = now;
    box.value = short_number(now);
  };
  return field;
}
const short_number = (value) => Number(Number(value).toPrecision(8));

const kLeftOut = ["schema", "name", "uncertainty", "uncertainty_correlations", "effects"];
/** All numbers of a value, in the order of the file. */
export function fields_of(file, value, path = []) {
  const list = [];
  for (const [key, item] of Object.entries(value)) {
    const here = [...path, Array.isArray(value) ? Number(key) : key];
    if (kLeftOut.includes(key) && !path.length) continue;
    if (is_number(item)) list.push(number_field({file, path: here, value: item, label: label_of(here, value)}));
    else if (item && typeof item === "object" && key !== "polygon_m") list.push(...fields_of(file, item, here));
  }
  return list;
}
function label_of(path, parent) {
  const key = path.at(-1);
  if (key === "left" || key === "right") return `${split_key(path.at(-2)).words}, ${key}`;
  if (path.includes("by_payload") && key === "payload_kg") return `payload, row ${path.at(-2) + 1}`;
  if (path.includes("by_payload")) return `${split_key(key).words} at ${short(parent.payload_kg)} kg`;
  return split_key(String(key)).words;
}
/** Unit of sided values: that of the key above. */
const unit_of = (path) => split_key(String(["left", "right"].includes(path.at(-1)) ? path.at(-2) : path.at(-1))).unit;
