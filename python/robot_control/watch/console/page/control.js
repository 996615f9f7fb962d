// Who has control, and with which speeds: take, release, hand over.
import { by, choices, list, number, put, value } from "/dom.js";
import { on, send } from "/link.js";
import { released } from "/drive.js";

const SPEEDS = ["linear", "angular", "lateral"];
let authority = null;

on("authority", (next) => {
  const first = !authority, mine = next.commander === next.you, taken = next.commander !== null && !mine;
  authority = next;
  const commander = next.pages.find((page) => page.number === next.commander);
  const other = commander ? `${commander.name} (page ${commander.number}) has control.` : "Control is free.";
  put("control", mine ? "You have control." : other);
  const denied = String(next.role === "watch" || (taken && next.role !== "maintain"));
  for (const id of ["take", "take-here"]) {
    by(id).hidden = mine;
    put(id, taken ? "Take it away" : "Take control");
    by(id).setAttribute("aria-disabled", denied);
  }
  by("give").hidden = !mine;
  put("dead-man", next.dead_man || released);
  by("hold").hidden = !mine || Boolean(next.dead_man || released);
  by("chosen").textContent = mine ? `${number(Math.min(next.chosen[0], next.link.cap))} m/s` : "";
  list("pages", next.pages.map(({ name, number: page, role }) =>
    [name, `page ${page}`, role, page === next.you && "this one", page === next.commander && "has control"]
      .filter(Boolean).join(", ")));
  put("role", `role: ${next.role}`);
  const drivers = next.pages.filter((page) => page.number !== next.you && page.role !== "watch");
  by("hand-over").hidden = !mine || !drivers.length;
  choices("other", drivers.map((page) => `${page.number} ${page.name}`));
  for (const [at, id] of SPEEDS.entries()) {
    const edited = document.activeElement === by(id);
    if (first || (!edited && value(id) !== next.chosen[at])) by(id).value = number(next.chosen[at]);
    by(id).max = next.limits[at];
  }
  by("heartbeat").checked = next.heartbeat;
});

for (const id of ["take", "take-here"]) {
  by(id).addEventListener("click", () => send({ type: "take", force: authority?.commander !== null }));
}
by("give").addEventListener("click", () => send({ type: "give_back" }));
by("hand").addEventListener("click", () => send({ type: "hand_over", to: Number(by("other").value.split(" ")[0]) }));
by("heartbeat").addEventListener("change", () => send({ type: "heartbeat", on: by("heartbeat").checked }));
for (const id of SPEEDS) {
  const chosen = () => Object.fromEntries(SPEEDS.map((name) => [name, value(name)]));
  by(id).addEventListener("change", () => send({ type: "speeds", ...chosen() }));
}
