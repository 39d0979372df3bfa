/** Numbers and keys as text. */
export const is_number = (value) => typeof value === "number" && isFinite(value);

/** About `digits` significant digits, thin spaces between thousands, a real minus. */
export function number(value, digits = 4) {
  if (!is_number(value)) return "–";
  if (Math.abs(value) < 1e-9) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size >= 7 || size < -4) return value.toExponential(digits - 1).replace("-", "\u2212");
  const places = Math.max(0, Math.min(digits - 1 - size, 6));
  const [whole, part] = Math.abs(value).toFixed(places).split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+(?!\d))/g, "\u2009") : whole;
  return (value < 0 && Number(value.toFixed(places)) !== 0 ? "\u2212" : "") + grouped + (part ? "." + part : "");
}
/** Without zeros at the end: for axes and settings. */
export const short = (value, digits = 4) => number(value, digits).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
export const with_unit = (value, unit, digits) => (is_number(value) ? number(value, digits) + "\u202f" + unit : "–");
export const percent = (value, digits = 3) => with_unit(value, "%", digits);
/** A percentage that is an upper bound: rounded up. */
export function at_most_percent(value, digits = 2) {
  const unit = 10 ** (Math.floor(Math.log10(Math.abs(value))) - digits + 1);
  return percent(value ? unit * Math.ceil(value / unit) : value, digits);
}
export const fraction = (value, digits = 3) => percent(is_number(value) ? 100 * value : value, digits);
/** A difference with its sign. */
export const signed = (value, digits = 3) => (is_number(value) && value > 0 ? "+" : "") + number(value, digits);
export const words = (name) => String(name ?? "").replace(/_/g, " ");

const kUnits = [["_Nm_s_rad", "N m s/rad"], ["_N_s2_m2", "N s²/m²"], ["_N_s_m", "N s/m"], ["_V_s_rad", "V s/rad"], ["_kg_m2", "kg m²"], ["_rad_s2", "rad/s²"], ["_m_s2", "m/s²"],
  ["_m_s3", "m/s³"], ["_Nm_A", "N m/A"], ["_rad_s", "rad/s"], ["_m_s", "m/s"], ["_per_m", "1/m"], ["_percent", "%"], ["_Nm", "N m"], ["_ohm", "Ω"], ["_rad", "rad"], ["_m2", "m²"],
  ["_Wh", "Wh"], ["_kg", "kg"], ["_m", "m"], ["_s", "s"], ["_J", "J"], ["_W", "W"], ["_V", "V"], ["_A", "A"], ["_C", "°C"], ["_H", "H"]];
/** "speed_m_s" -> {words: "speed", unit: "m/s"}. */
export function split_key(key) {
  const entry = kUnits.find(([ending]) => key.endsWith(ending));
  return entry ? {words: words(key.slice(0, -entry[0].length)), unit: entry[1]} : {words: words(key), unit: ""};
}

/** Round numbers for an axis from low to high. */
export function ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const raw = span / Math.max(1, count), power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((m) => m >= raw);
  const list = [];
  for (let value = Math.ceil(low / step - 1e-9) * step; value <= high + 1e-9 * span; value += step) list.push(Math.abs(value) < 1e-9 * step ? 0 : value);
  return list;
}

/** Index of the last value at or below x in an ascending list. */
export function row_at(values, x) {
  let low = 0, high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= x) low = middle; else high = middle - 1;
  }
  return low;
}
/** A column at x, linear between rows. */
export function value_at(xs, ys, x) {
  const k = row_at(xs, x);
  if (k + 1 >= xs.length || x <= xs[k]) return ys[k];
  return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k]);
}
