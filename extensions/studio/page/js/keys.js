/** Keys of the whole page. */
import {redo, store, undo} from "studio/store.js";
import {save} from "studio/share.js";

export function listen() {
  document.addEventListener("keydown", (event) => {
    const typing = /TEXTAREA/.test(event.target.tagName) || (event.target.tagName === "INPUT" && event.target.type === "number");
    if (!(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    if (key === "s" && store.served) save();
    else if (typing) return;
    else if (key === "z" && !event.shiftKey) undo();
    else if (key === "y" || (key === "z" && event.shiftKey)) redo();
    else return;
    event.preventDefault();
  });
}
