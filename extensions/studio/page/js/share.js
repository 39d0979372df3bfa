/** Save, copy the command, write the page as one file. */
import {announce, button, h} from "page/dom.js";
import {has_core} from "studio/answers.js";
import {is_saved, on, set_files, store} from "studio/store.js";

let told;
export function tell(text, bad) {
  told.textContent = text;
  told.className = "told" + (bad ? " bad" : "");
  announce(text);
}

export async function save() {
  const response = await fetch("save", {method: "POST", headers: {"Content-Type": "application/json"},
    body: JSON.stringify({mission: store.mission, robot: store.robot, base: store.files.base})});
  const answer = await response.json();
  if (answer.error) return tell("Not saved: " + answer.error.message, true);
  if (answer.conflict) return tell(`Not saved: ${answer.conflict} was changed by another program. Reload it, or undo the change there.`, true);
  const edits = store.edits;
  set_files(answer, false);
  if (edits === store.edits) store.mission.robot = answer.mission.robot;
  tell("Saved " + answer.mission_file + (answer.robot_file.includes(store.files.name + "_robot") ? " and " + answer.robot_file : ""));
}
async function reload() {
  const response = await fetch("files");
  set_files(await response.json(), true);
  tell("Read again from the disk.");
}
async function look_at_disk() {
  const files = await (await fetch("files")).json();
  if (!files.error && (files.base.mission !== store.files.base.mission || files.base.robot !== store.files.base.robot)) tell("The files were changed on the disk. Reload them before you save.", true);
}

const quoted = (text) => (/^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
const command = () => `joulepath plan ${quoted(store.files.mission_file)} --solver fast --without baselines --out out/${quoted(store.files.name)}`;
async function copy() {
  const text = command();
  try { await navigator.clipboard.writeText(text); tell(is_saved() ? "Copied: " + text : "Copied; save first, or the command plans the mission as it is on the disk: " + text, !is_saved()); } catch { tell(text); }
}

/** The page with the present mission, robot and plan as one file that needs no program and no network. */
export function page_text() {
  const copy = document.documentElement.cloneNode(true);
  const data = {files: JSON.stringify({...store.files, mission: store.mission, robot: store.robot}), floor: store.floor, schemas: store.schemas, served: false, version: store.version_of_program, answer: store.answer,
    diagnosis: store.diagnosis, beside: {kept: store.kept, classics: store.classics, front: store.front}};
  for (const mark of ["ready", "state"]) delete copy.dataset[mark];
  copy.querySelector("#app").replaceChildren();
  copy.querySelectorAll("script[type=importmap], script[type=module], .unseen[aria-live]").forEach((element) => element.remove());
  copy.querySelector("#data").textContent = JSON.stringify(data).replaceAll("<", "\\u003c");
  return "<!doctype html>\n" + copy.outerHTML;
}
function share() {
  const link = h("a", {href: URL.createObjectURL(new Blob([page_text()], {type: "text/html"})), download: store.files.name + ".studio.html"});
  link.click();
  tell(has_core() ? "Written: the page plans without the program, along the ways it has." : "Written: this build has no WebAssembly, so that the page only shows the plan.");
}

export function file_tools() {
  told = h("p", {class: "told", role: "status"});
  const saving = button("Save", save, {id: "save"}), reloading = button("Reload", reload, {id: "reload"});
  const show = () => { saving.disabled = is_saved(); };
  ["edit", "files", "answer"].forEach((event) => on(event, show));
  show();
  if (store.served) window.addEventListener("focus", look_at_disk);
  window.addEventListener("beforeunload", (event) => { if (store.served && !is_saved()) event.preventDefault(); });
  return {buttons: [...(store.served ? [saving, reloading, button("Copy command", copy, {id: "copy"})] : []), button("Share as a file", share, {id: "share"})], told};
}
