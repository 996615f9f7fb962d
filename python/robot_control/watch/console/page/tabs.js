// The parts of the console: each is one press away, and the last one is remembered.
import { by } from "/dom.js";
import { icon } from "/icons.js";

const KEY = "console-tab", buttons = [...by("tabs").children];
const changed = [];

/** Calls `then` with the name of each part that is opened. */
export const onTab = (then) => changed.push(then);
export const tab = () => document.body.dataset.tab;

export function openTab(name) {
  document.body.dataset.tab = name;
  document.body.dataset.options = "";
  by("mini").setAttribute("aria-expanded", "false");
  for (const button of buttons) {
    if (button.dataset.tab === name) button.setAttribute("aria-current", "page");
    else button.removeAttribute("aria-current");
  }
  by("sheet").scrollTop = 0;
  try { localStorage.setItem(KEY, name); } catch { /* a browser without storage forgets */ }
  for (const then of changed) then(name);
}

for (const button of buttons) {
  button.prepend(icon(button.dataset.tab));
  button.addEventListener("click", () => openTab(button.dataset.tab));
}
by("mini").addEventListener("click", () => {
  const open = document.body.dataset.options !== "open";
  document.body.dataset.options = open ? "open" : "";
  by("mini").setAttribute("aria-expanded", String(open));
});

let last = "drive";
try { last = localStorage.getItem(KEY) ?? last; } catch { /* as above */ }
openTab(buttons.some((button) => button.dataset.tab === last) ? last : "drive");
