// What happened, what was measured, and the one step to do; below, folded, what an integrator needs.
import { by, list, make, number, put, show, rows } from "/dom.js";
import { on, silent } from "/link.js";
import { openTab, tab } from "/tabs.js";
import { words } from "/words.js";

const STAYS = 600;  // ms that a robot is not ready before the page says so unasked: a start takes a moment
let open = false, closed = "", since = Infinity, at = "", cause = "";

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** Value, limit and place of "17.3 rad/s, limit 15 rad/s, left_wheel_joint". */
function evidenceOf(detail) {
  if (!detail) return [];
  const parts = detail.split(", "), limit = parts.find((part) => part.startsWith("limit "));
  const [measured, ...places] = parts.filter((part) => part !== limit);
  return [["measured", measured], ["allowed", limit?.slice(6)], ["place", places.join(", ")]];
}

function evidence(pairs) {
  const found = pairs.filter(([, text]) => text);
  rows(by("evidence"), found.length, () => make("div", {}, make("dt"), make("dd"))).forEach(({ children }, i) => {
    show(children[0], words(found[i][0]));
    show(children[1], words(found[i][1]));
  });
}

/** Lines for a shell, each with a button that copies it. */
export function commands(parent, lines) {
  rows(parent, lines.length, () => {
    const copy = make("button", { textContent: words("Copy") });
    const row = make("p", { className: "command" }, make("code"), copy);
    copy.addEventListener("click", () => navigator.clipboard?.writeText(row.firstChild.textContent));
    return row;
  }).forEach((row, i) => show(row.firstChild, lines[i]));
}

function fateOf({ safety, legged }) {
  if (safety.state === "STOPPING") return "The robot is stopping.";
  return legged ? "The robot was stopped and lies. It stays so until it is reset."
    : "The robot was stopped. It stays so until it is reset.";
}

on("slow", (slow) => {
  const { safety, verdict } = slow, causes = [...(safety?.causes ?? [])].sort((a, b) => b.first - a.first);
  const stopped = verdict === "stopped", first = causes[0], none = stopped && !safety;
  since = stopped ? Math.min(since, performance.now()) : Infinity;
  if (first && slow.replay) at = `${number(slow.replay.at - safety.held, 1)} s`;
  else if (first && cause !== first.name) at = new Date(Date.now() - 1000 * safety.held).toLocaleTimeString();
  cause = first?.name ?? "";
  const what = stopped ? slow.headline : "";
  if (!stopped) closed = "";
  const shown = open || (stopped && closed !== cause + safety?.state && performance.now() - since > STAYS);
  by("why").hidden = !shown;
  by("sentence").setAttribute("aria-expanded", String(shown));
  document.body.dataset.why = shown ? (stopped ? "stop" : "open") : "";
  if (shown && stopped) by("help").hidden = true;
  if (!shown) return;
  show(by("why-title"), capital(words(first ? first.sentence : what || slow.sentence)));
  evidence(first ? [...evidenceOf(first.detail), ["at", at]] : []);
  const asks = !slow.steps.length && slow.integrator.length && stopped && !none;
  put("why-text", first ? fateOf(slow) : stopped || slow.sentence === slow.headline ? "" : slow.headline);
  list("steps", asks ? ["Ask the integrator to repair it, then reset."] : slow.steps);
  const notes = { limited: slow.limits, warning: safety?.warnings ?? [], odometry: slow.odometry };
  list("reasons", Object.entries(notes).flatMap(([kind, texts]) => texts.map((text) => `${kind}: ${text}`)));
  by("reset").hidden = !first;
  by("resume").hidden = !(slow.paused && slow.simulated && stopped && !first);
  by("first-step").hidden = by("reset").hidden && by("resume").hidden;
  by("start").hidden = !none;
  commands(by("start"), none ? slow.commands : []);
  list("causes", causes.map(({ name, first: came, sentence, detail, active }) =>
    `${name}: ${words(`${came ? "first: " : ""}${sentence}${detail ? ` (${detail})` : ""}${active ? ", still true" : ""}`)}`));
  list("actions", slow.integrator.map(([actor, text]) => `${actor}: ${text}`));
  commands(by("commands"), none ? [] : slow.commands);
  by("integrator").hidden = none || !(causes.length || slow.integrator.length || slow.commands.length);
  by("why").dataset.key = cause + safety?.state;
});

function toggle() {
  const shown = !by("why").hidden && tab() === "drive";
  if (!shown) openTab("drive");
  open = !shown;
  closed = shown ? by("why").dataset.key ?? "" : "";
  by("why").hidden = shown;
  document.body.dataset.why = open ? "open" : "";
  if (open && !silent()) by("why").hidden = false;
}
by("sentence").addEventListener("click", toggle);
by("why-close").addEventListener("click", toggle);
