/** Elements. h("p", {class: "soft", onclick: f}, "text", child): null children are left out. */
export function h(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "style") element.style.cssText = value;
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat(4).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

const live = h("div", {class: "unseen", "aria-live": "polite"});

/** Announces a sentence to screen readers. */
export function announce(text) {
  if (!live.isConnected) document.body.append(live);
  live.textContent = text;
}

/** A dash pattern of a canvas as a background. */
function dashes(color, pattern) {
  let at = 0;
  const stops = pattern.map((length, k) => { const from = at; at += length; return `${k % 2 ? "transparent" : color} ${from}px ${at}px`; });
  return `background:repeating-linear-gradient(90deg, ${stops.join(", ")})`;
}
/** An entry of a legend; `look`: "" a line, "box", the dash pattern of the line, or a picture. */
export const key = (text, color, look = "") => {
  if (look instanceof Node) return h("span", {class: "key"}, look, text);
  const dashed = Array.isArray(look);
  return h("span", {class: "key"}, h("i", {class: dashed ? "dash" : look, style: dashed ? dashes(color, look) : look === "box" ? `background:${color}` : `border-color:${color}`}), text);
};
export const button = (text, onclick, attributes = {}) => h("button", {type: "button", onclick, ...attributes}, text);

/** A canvas of its element's size in sharp pixels; {context, width, height} in CSS pixels. */
export function sharp(canvas, height) {
  const width = Math.max(60, canvas.parentElement.clientWidth), ratio = Math.max(1, window.devicePixelRatio || 1);
  const tall = Math.max(40, height ?? canvas.parentElement.clientHeight);
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(tall * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(tall * ratio);
    canvas.style.width = width + "px";
    canvas.style.height = tall + "px";
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return {context, width, height: tall};
}
