// Keys and legend, on "?"; and three hints at the first visit.
import { by, make } from "/dom.js";
import { openTab } from "/tabs.js";
import { words } from "/words.js";

const KEY = "console-seen";
const KEYS = [
  ["w a s d, q e z c", "drive while the key is held"],
  ["j l, Shift", "sideways, on legs"],
  ["Space", "let go"],
  ["Esc", "emergency stop; at rest it first closes what is open"],
  [", .", "turn the view"], ["PageUp, PageDown", "tilt the view"], ["+ -", "enlarge or reduce the view"],
  ["1 2 3 4 5", "Drive, Map, Plots, Logs, Setup"],
  ["?", "this help"],
];
const LEGEND = [
  ["measured", "line behind the robot: the way driven"], ["limited", "dashed: the way that is wanted"],
  ["true", "ring: where the simulator has the robot"], ["asked", "arrow: the speed that is asked for"],
  ["measured", "arrow: the speed measured"],
];
const HINTS = ["Take control, then hold the stick. Let go, and the robot stops.",
  "STOP is always there. It needs no control.", "Drag the scene to turn it, press ? for keys and legend."];
const help = by("help");

const terms = (pairs) => make("dl", {}, ...pairs.flatMap(([term, text]) =>
  [make("dt", {}, term), make("dd", { textContent: words(text) })]));

function openHelp() {
  const legend = LEGEND.map(([kind, text]) => [make("i", { className: `key ${kind}` }), text]);
  const close = make("button", { textContent: words("Close"), className: "strong" });
  close.addEventListener("click", () => { help.hidden = true; });
  help.replaceChildren(make("h2", { textContent: words("Keys") }), terms(KEYS),
    make("h2", { textContent: words("Legend") }), terms(legend), make("p", { className: "row" }, close));
  openTab("drive");
  help.hidden = false;
  close.focus();
}
by("help-open").addEventListener("click", openHelp);
addEventListener("keydown", ({ key, target }) => {
  if (target.closest?.("input, textarea, select")) return;
  if (key === "?") openHelp();
  if (key === "Escape") help.hidden = true;
  by("tabs").children[Number(key) - 1]?.click();
});

by("hints").querySelector("ol").append(...HINTS.map((text) => make("li", { textContent: words(text) })));
by("hints-close").addEventListener("click", () => {
  by("hints").hidden = true;
  try { localStorage.setItem(KEY, "yes"); } catch { /* a browser without storage shows them again */ }
});
try { by("hints").hidden = Boolean(localStorage.getItem(KEY)); } catch { /* as above */ }
