/**
 * Answers of the planner. Drafts come from WebAssembly where the page has it, from the program otherwise; a plan is
 * certified by the program where there is one. Design: docs/decisions/0702-studio-and-reports.md
 */
import {legs, place_after, straight} from "studio/editing.js";
import {emit, has_legs, on, store} from "studio/store.js";

const core_js = document.getElementById("core-js").textContent.replaceAll("<\\/script", "</script"), core_wasm = document.getElementById("core-wasm").textContent;
export const has_core = () => core_wasm.length > 0;
const page_name = Math.random().toString(36).slice(2);

const kWorker = `
let call;
onmessage = async ({data}) => {
  if (data.wasm) {
    const core = await joulepath_core({wasmBinary: data.wasm, print() {}, printErr() {}});
    call = (name, text) => {
      const size = core.lengthBytesUTF8(text) + 1, at = core._malloc(size);
      core.stringToUTF8(text, at, size);
      const answer = core.UTF8ToString(core[name](at));
      core._free(at);
      return answer;
    };
    call("_joulepath_open", data.floor);
    postMessage({ready: true});
  } else {
    const began = performance.now();
    let answer;
    try { answer = call("_joulepath_answer", data.question); } catch (error) { answer = JSON.stringify({error: {message: "the planner stopped: " + error}}); }
    postMessage({id: data.id, answer, took_ms: performance.now() - began});
  }
};`;

/** Settings of drafts for benchmarks: {nodes, by_program}. */
const studio_draft = () => window.studio.draft || {};

let wasm_bytes;
async function core_bytes() {
  if (!wasm_bytes) {
    const packed = Uint8Array.from(atob(core_wasm.trim()), (c) => c.charCodeAt(0));
    wasm_bytes = new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  }
  return (await wasm_bytes).slice(0);
}

/** A planner in a separate thread; an outdated question ends with its thread. */
class Lane {
  async open() {
    this.worker = new Worker(URL.createObjectURL(new Blob([core_js + "\n" + kWorker], {type: "text/javascript"})));
    this.waiting = new Map();
    const ready = new Promise((resolve, reject) => {
      this.worker.onmessage = ({data}) => {
        if (data.ready) return resolve();
        const done = this.waiting.get(data.id);
        this.waiting.delete(data.id);
        if (done) done(data.answer);
      };
      this.worker.onerror = (event) => reject(new Error(event.message));
    });
    this.worker.postMessage({wasm: await core_bytes(), floor: JSON.stringify(store.floor)});
    await ready;
    return this;
  }
  busy() { return this.waiting && this.waiting.size > 0; }
  ask(text) {
    const id = Math.random();
    return new Promise((resolve) => { this.waiting.set(id, resolve); this.worker.postMessage({id, question: text}); });
  }
  close() { this.worker.terminate(); this.waiting.forEach((done) => done('{"superseded": true}')); }
}

const lanes = {};
async function in_core(lane, text, replaces) {
  if (replaces && lanes[lane]) {
    const old = await lanes[lane];
    if (old.busy()) { old.close(); delete lanes[lane]; }
  }
  lanes[lane] = lanes[lane] || new Lane().open();
  return (await lanes[lane]).ask(text);
}

async function in_program(text) {
  const response = await fetch("answer", {method: "POST", headers: {"Content-Type": "application/json"}, body: text});
  return response.text();
}

/** Stops in an order that the planner chooses: between its searches they keep the order of the last plan. */
const is_ordered = () => !has_legs() && Array.isArray(store.mission.visit);
function ordered_mission() {
  const {visit, ...mission} = store.mission, latest = (name) => ((visit.find((one) => [one.pick, one.drop, one.go].includes(name)) || {}).window_s || [])[1];
  return {...mission, legs: store.answer.plan.legs.map((leg) => ({to: leg.to, payload_kg: leg.payload_kg, dwell_s: leg.dwell_s, deadline_s: latest(leg.to)}))};
}

/** One question about the mission as it is now; `at_once`: the page's own planner may not be open yet. */
export async function ask(mode, extra = {}, at_once = false) {
  const mission = mode !== "plan" && is_ordered() && store.answer ? ordered_mission() : store.mission;
  const question = JSON.stringify({mode, page: page_name, name: store.files.name, mission, robot: store.robot, paths: store.ways, ...extra});
  const draft = mode === "draft";
  // An order is a file, which the program alone reads.
  const by_program = store.served && (!draft || at_once || !has_core() || store.mission.order || studio_draft().by_program);
  if (!by_program && !has_core()) return {error: {message: "this page contains no planner: open the mission with joulepath studio"}};
  const text = by_program ? await in_program(question) : await in_core(mode, question, !draft);
  return JSON.parse(text);
}

let sketched = false;
function take(answer, state, edits) {
  if (answer.superseded) return;
  if (sketched) Object.assign(store, {answer: null, state: "none"});
  sketched = false;
  if (answer.error) {
    store.problem = answer.error.message.replace(/^[^ ]*\.json(:\d+:\d+)?: /, "");
  } else {
    store.verdict = answer.plan;
    store.problem = answer.motion ? "" : answer.plan.message || answer.plan.status;
    if (answer.motion) {
      store.answer = answer;
      store.state = state;
      if (edits === store.edits && (has_legs() ? answer.legs.length === store.mission.legs.length : is_ordered()))
        store.ways = answer.legs.map((leg) => leg.path);
    }
  }
  emit("answer");
}

const moves_stops = () => is_ordered() || (has_legs() && store.mission.legs.some((leg) => leg.to !== undefined));
const ways_are_known = () => {
  if (store.mission.order) return store.served;
  if (is_ordered()) return !!store.answer && store.answer.plan.legs.every((_, k) => Array.isArray(store.ways[k]));
  return has_legs() && store.mission.legs.every((leg, k) => leg.to === undefined || Array.isArray(store.ways[k]));
};

function working(text) { store.working = text; emit("working"); }

let drafting = false, draft_again = false;
async function draft() {
  if (drafting) { draft_again = true; return; }
  drafting = true;
  do {
    draft_again = false;
    const edits = store.edits;
    const answer = await ask("draft", {samples: 300, nodes: studio_draft().nodes});
    if (settled < edits) take(answer, "draft", edits);
    emit("drafted", edits);
  } while (draft_again);
  drafting = false;
}

let settled = 0;
/** Certifies the present mission: at once along its ways, then with a new search of ways where stops have moved. */
async function settle() {
  const edits = store.edits;
  const current = () => edits === store.edits;
  if (ways_are_known()) {
    working("certifying");
    const answer = await ask("paths");
    if (!current()) return;
    settled = edits;
    take(answer, moves_stops() ? "certified" : "planned", edits);
  }
  if (store.served && (moves_stops() || !ways_are_known())) {
    working("searching ways");
    const answer = await ask("plan");
    if (!current()) return;
    settled = edits;
    take(answer, "planned", edits);
  }
  working("");
  emit("settled");
}

// Registered before the listeners of the panels, which show the state that follows from an edit.
let timer;
on("edit", ({release}) => {
  store.classics = store.front = null;
  if (store.state === "planned" || store.state === "certified") store.state = "draft";
  if (ways_are_known()) draft();
  clearTimeout(timer);
  if (!release) return;
  working("certifying");
  timer = setTimeout(settle, 60);
});

/** A picture while the first search runs: a draft along straight lines between the stops. */
async function sketch() {
  if (!has_legs() || ways_are_known()) return;
  const answer = await ask("draft", {samples: 300, paths: legs().map((leg, k) => (leg.to ? straight(place_after(k - 1), place_after(k)) : null))}, true);
  if (store.answer || store.verdict || store.problem || store.edits || !answer.motion) return;
  Object.assign(store, {answer, verdict: answer.plan, state: "draft"});
  sketched = true;
  emit("answer");
}

/** The first plan of the page. */
export function start() {
  if (store.first_answer) { take(store.first_answer, "planned", 0); emit("settled"); } else { sketch(); settle(); }
}
