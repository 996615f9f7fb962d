// What a page asks of the robot: calls, the emergency stop and the reset; and the answers.
import { by, list, value } from "/dom.js";
import { on, send, call } from "/link.js";
import { release } from "/drive.js";
import { words } from "/words.js";

const E_STOP_LIMIT = 4000;  // ms; the server answers after 3 s at the latest
const PAUSE = 600;          // ms; the server refuses a confirmation that comes sooner
const TOAST = 7000, KEPT = 30;  // ms that an answer is shown, number of answers in the log
const messages = [];
let authority = null, robot = null, key = "", toast = 0;

/** Shows an answer, and keeps it in the log. */
export function say(english) {
  const text = words(english);
  by("toast").textContent = text;
  by("toast").hidden = false;
  clearTimeout(toast);
  toast = setTimeout(() => { by("toast").hidden = true; }, TOAST);
  if (messages[0]?.endsWith(` ${text}`)) return;
  messages.unshift(`${new Date().toLocaleTimeString()} ${text}`);
  messages.length = Math.min(messages.length, KEPT);
  list("messages", messages);
}
on("said", ({ text }) => say(text));
on("slow", (slow) => { robot = slow; });

const speed = () => value("path-speed");
const ARGUMENTS = {
  path_points: async () => {
    const { draw } = await import("/scene.js");
    say("draw a stroke on the ground; Esc or a second finger cancels");
    const points = await draw();
    return points.length > 1 ? { points, speed: speed() } : null;
  },
  goal: () => placeOnMap("goal"),
  place: () => placeOnMap("place"),
  path_shape: () => ({ shape: by("shape").value, size: value("size"), speed: speed() }),
  path_csv: async () => {
    const [file] = by("csv").files;
    return file ? { text: await file.text(), speed: speed() } : null;
  },
  set_gait: (button) => ({ gait: button.dataset.gait }),
  set_posture: (button) => ({ posture: button.dataset.posture }),
  set_odometry: () => ({ x: value("x"), y: value("y"), yaw: value("yaw") }),
  set_parameters: () => ({ parameters: by("parameters").value }),
  pause: () => ({ on: !robot?.paused }),
  step: () => ({ cycles: 100 }),
  inject_fault: () => ({ component: by("component").value, kind: by("kind").value }),
};

async function placeOnMap(what) {
  const { draw } = await import("/scene.js"), { onMap } = await import("/map.js");
  say(`${what}: press on the map, drag to the heading, release; Esc or a second finger cancels`);
  const points = await draw();
  return points.length ? onMap(points[0], points[points.length - 1]) : null;
}

addEventListener("click", async ({ target }) => {
  const button = target.closest?.("[data-call]");
  if (!button) return;
  const name = button.dataset.call, label = button.textContent, why = authority?.against[name];
  if (why) return say(`${label}: ${why}`);
  const args = ARGUMENTS[name] ? await ARGUMENTS[name](button) : {};
  if (args === null) return say(`${label}: nothing was chosen`);
  const { accepted, text } = await call(name, args);
  say(`${label}: ${accepted ? "" : "refused: "}${text}`);
});

on("authority", (next) => {
  authority = next;
  for (const button of document.querySelectorAll("[data-call]")) {
    const why = words(next.against[button.dataset.call]);
    if (button.title !== why) button.title = why;
    button.setAttribute("aria-disabled", String(Boolean(why)));
  }
  by("reset").setAttribute("aria-disabled", String(Boolean(againstReset())));
});

by("e-stop").addEventListener("click", async () => {
  release();
  try {
    const signal = AbortSignal.timeout(E_STOP_LIMIT);
    const answer = await fetch("/api/e_stop", { method: "POST", keepalive: true, signal });
    const { confirmed, text } = answer.ok ? await answer.json() : { confirmed: false, text: await answer.text() };
    say(confirmed ? "emergency stop confirmed" : `EMERGENCY STOP NOT CONFIRMED: ${text}`);
  } catch {
    say("EMERGENCY STOP NOT CONFIRMED: the console does not answer; press the button on the robot");
  }
});

// The reset needs control: where nobody has it, the first press takes it, too.
const free = () => authority?.commander === null && authority.role !== "watch";
const againstReset = () => free() ? "" : authority?.against.reset_asked ?? "";

by("reset").addEventListener("click", async () => {
  const why = againstReset();
  if (why) return say(`${by("reset").textContent}: ${why}`);
  if (free()) send({ type: "take", force: false });
  const { accepted, text } = await call("reset_asked");
  if (!accepted) return say(`${by("reset").textContent}: refused: ${text}`);
  const { causes = [], refusal = [] } = robot?.safety ?? {}, active = causes.filter((cause) => cause.active);
  const reasons = [...active.map(({ sentence, remedy }) => remedy ? `${sentence}: ${remedy}` : sentence), ...refusal];
  key = text;
  const none = "Nothing prevents it. Check the robot first.";
  by("against").textContent = words(reasons.length ? `The reset is prevented by: ${reasons.join("; ")}` : none);
  by("confirm-reset").disabled = true;
  confirming(true);
  setTimeout(() => {
    by("confirm-reset").disabled = false;
    by("confirm-reset").focus();
  }, PAUSE);
});

function confirming(begins) {
  by("confirm").hidden = !begins;
  by("first-step").classList.toggle("asked-once", begins);
}
by("confirm-reset").addEventListener("click", async () => {
  confirming(false);
  say((await call("reset", { key })).text);
});
by("cancel-reset").addEventListener("click", () => confirming(false));
