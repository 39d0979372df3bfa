/** A section that can be closed; what is open stays in mind. */
import {h} from "page/dom.js";

export function section(title, id, ...children) {
  const open = sessionStorageGet("open:" + id) !== "no";
  const details = h("details", {id, class: "section", open}, h("summary", {}, h("h2", {}, title)), ...children);
  details.addEventListener("toggle", () => sessionStorageSet("open:" + id, details.open ? "yes" : "no"));
  return details;
}

function sessionStorageGet(key) { try { return sessionStorage.getItem(key); } catch { return null; } }
function sessionStorageSet(key, value) { try { sessionStorage.setItem(key, value); } catch { /* a page from a file may have no storage */ } }
