/** Colors of the theme for canvases, and one color for each limit. */
export const color = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

export const is_dark = () => {
  const asked = document.documentElement.dataset.theme;
  return asked ? asked === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
};

/** Ten colors that differ as far as possible for every kind of color vision; the names are always shown, too. */
const kLimitColors = {speed: ["#0072b2", "#56b4e9"], acceleration: ["#d55e00", "#f58a3c"], deceleration: ["#9c2f00", "#ffb08a"], lateral_acceleration: ["#a8467f", "#e291c3"],
  yaw_rate: ["#00694c", "#3ccf9f"], yaw_acceleration: ["#5b6f00", "#c3d94e"], wheel_acceleration: ["#6a51a3", "#b3a2e8"], jerk: ["#8a5a00", "#e6c35c"], traction: ["#7f3b08", "#d9a066"],
  motor_power: ["#b2182b", "#ff8f8f"], battery_power: ["#542788", "#c9a7f5"], motor_current: ["#c51b7d", "#ff9ad1"], motor_voltage: ["#01665e", "#7fd6c8"]};
export const limit_color = (name) => (kLimitColors[name] || ["#59626e", "#a5afbb"])[is_dark() ? 1 : 0];
/** Color where no limit binds. */
export const free_color = () => color("free");

const kRamp = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
/** Viridis without the end that is not visible on the background. */
export function ramp(fraction) {
  const [low, high] = is_dark() ? [0.22, 1] : [0, 0.88];
  const t = (low + (high - low) * Math.min(1, Math.max(0, fraction))) * (kRamp.length - 1);
  const k = Math.min(kRamp.length - 2, Math.floor(t));
  return `rgb(${kRamp[k].map((from, channel) => Math.round(from + (t - k) * (kRamp[k + 1][channel] - from))).join(",")})`;
}

/** Calls `redraw` whenever colors change. */
export function on_theme(redraw) {
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  new MutationObserver(redraw).observe(document.documentElement, {attributes: true, attributeFilter: ["data-theme"]});
}
export const toggle_theme = () => { document.documentElement.dataset.theme = is_dark() ? "light" : "dark"; };
export const ramp_css = () => `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map(ramp).join(",")})`;
