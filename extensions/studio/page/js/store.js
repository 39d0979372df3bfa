/**
 * State of the page: the mission and the robot as in their files, the ways of the legs from the last answer, the last
 * answer, and the selection. Every change goes through change(), so that it can be undone.
 */
const data = JSON.parse(document.getElementById("data").textContent);
const files = JSON.parse(data.files);

export const store = {
  served: data.served, version_of_program: data.version, floor: data.floor, schemas: data.schemas, first_answer: data.answer || null, diagnosis: data.diagnosis || null,
  files, mission: structuredClone(files.mission), robot: structuredClone(files.robot), ways: [],
  answer: null,      // the last answer with a motion
  verdict: null,     // the plan of the last answer, with or without a motion
  state: "none",     // none | draft | certified | planned: how much the last answer is worth
  problem: "",       // why there is no newer answer
  working: "",       // what is being computed
  selection: {kind: "none"},
  drag: null,        // while a handle is dragged: {from: the plan when it began, at: [x, y] of the pointer on the canvas}
  cursor_s: 0,
  kept: null,        // plan A of a comparison: {answer, name}
  classics: null,    // classic profiles beside the plan
  front: null,
  ...data.beside,    // these three of a page that was shared
  edits: 0,          // counts changes; answers to older states are discarded
};

const listeners = {};
export const on = (event, listener) => (listeners[event] = listeners[event] || []).push(listener);
/** Calls a listener at the next event only. */
export function once(event, listener) {
  const first = (detail) => { listeners[event].splice(listeners[event].indexOf(first), 1); listener(detail); };
  on(event, first);
}
export const emit = (event, detail) => [...(listeners[event] || [])].forEach((listener) => listener(detail));

const snapshot = () => JSON.stringify({mission: store.mission, robot: store.robot, ways: store.ways});
const past = [], future = [];
let gesture = "", saved = snapshot_of_files();
function snapshot_of_files() { return JSON.stringify({mission: store.files.mission, robot: store.files.robot}); }

/**
 * Changes mission, robot or ways by `edit(store)`. Changes of the same gesture (a drag, a slider) are one step of undo.
 * `release`: the gesture has ended, so the plan is certified.
 */
export function change(edit, {of = "", release = true} = {}) {
  const before = snapshot();
  edit(store);
  const after = snapshot();
  if (after !== before) {
    if (!of || of !== gesture) past.push(before);
    if (past.length > 300) past.shift();
    gesture = of;
    future.length = 0;
    store.edits += 1;
  }
  if (release) gesture = "";
  if (after !== before || release) emit("edit", {release});
}

function restore(text) {
  Object.assign(store, JSON.parse(text));
  store.edits += 1;
  gesture = "";
  emit("edit", {release: true});
  emit("selection");
}
export const can_undo = () => past.length > 0;
export const can_redo = () => future.length > 0;
export function undo() { if (past.length) { future.push(snapshot()); restore(past.pop()); } }
export function redo() { if (future.length) { past.push(snapshot()); restore(future.pop()); } }

export const is_saved = () => saved === JSON.stringify({mission: store.mission, robot: store.robot});

/** Present content of the files. `adopt`: the page uses their values. */
export function set_files(next, adopt) {
  store.files = next;
  saved = snapshot_of_files();
  if (adopt) {
    past.push(snapshot());
    store.mission = structuredClone(next.mission);
    store.robot = structuredClone(next.robot);
    store.edits += 1;
    emit("edit", {release: true});
  }
  emit("files");
}

export function select(selection) {
  store.selection = selection;
  emit("selection");
}

export function set_cursor(time_s) {
  const end_s = store.answer ? store.answer.motion.time_s.at(-1) : 0;
  store.cursor_s = Math.min(end_s, Math.max(0, time_s));
  emit("cursor");
}

/** True if the page can edit order and number of the legs: they are given as `legs:`, not chosen by the planner. */
export const has_legs = () => Array.isArray(store.mission.legs) && store.mission.legs.length > 0;
