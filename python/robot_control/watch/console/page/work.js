// Command, reset and work: all of the page except its pictures, so that driving and the stop do not depend on those.
import { on, send, call, connect } from "/link.js";
import { release } from "/drive.js";
import { by, list, number } from "/panels.js";
import { words } from "/words.js";

const E_STOP_LIMIT = 4000;  // ms; the server answers after 3 s at the latest
const messages = [];
let authority = null, robot = null, key = "";

function say(english) {
  const text = words(english);
  if (messages[0]?.endsWith(` ${text}`)) return;
  messages.unshift(`${new Date().toLocaleTimeString()} ${text}`);
  messages.length = Math.min(messages.length, 8);
  list("messages", messages);
}
on("said", ({ text }) => say(text));

// What can fail is the robot's own list.
function fill(id, words) {
  if (words.join() === Array.from(by(id).options, (option) => option.text).join()) return;
  by(id).replaceChildren(...words.map((word) => new Option(word)));
}

const value = (id) => Number(by(id).value), speed = () => value("path-speed");
const ARGUMENTS = {
  path_points: async () => {
    const { draw } = await import("/scene.js");
    say("draw a stroke on the grid");
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
  set_gait: () => ({ gait: by("gait").value }),
  set_posture: (button) => ({ posture: button.dataset.posture }),
  set_odometry: () => ({ x: value("x"), y: value("y"), yaw: value("yaw") }),
  set_parameters: () => ({ parameters: by("parameters").value }),
  pause: () => ({ on: !robot?.paused }),
  step: () => ({ cycles: 100 }),
  inject_fault: () => ({ component: by("component").value, kind: by("kind").value }),
};

async function placeOnMap(what) {
  const { draw } = await import("/scene.js"), { onMap } = await import("/map.js");
  say(`${what}: press on the map, drag to the heading, release`);
  const points = await draw();
  return points.length ? onMap(points[0], points[points.length - 1]) : null;
}

for (const button of document.querySelectorAll("[data-call]")) {
  button.addEventListener("click", async () => {
    const name = button.dataset.call, why = authority?.against[name];
    if (why) return say(`${button.textContent}: ${why}`);
    const args = ARGUMENTS[name] ? await ARGUMENTS[name](button) : {};
    if (args === null) return say(`${button.textContent}: nothing was chosen`);
    const { accepted, text } = await call(name, args);
    if (name === "reset_asked" && accepted) return confirmReset(text);
    say(`${button.textContent}: ${accepted ? "" : "refused: "}${text}`);
  });
}

on("slow", (slow) => {
  robot = slow;
  fill("component", slow.components);
  fill("kind", slow.kinds);
  by("simulation").hidden = !slow.simulated;
  by("pause").textContent = words(slow.paused ? "Go on" : "Pause");
});

on("authority", (next) => {
  const first = !authority, mine = next.commander === next.you, taken = next.commander !== null && !mine;
  authority = next;
  for (const button of document.querySelectorAll("[data-call]")) {
    button.title = words(authority.against[button.dataset.call]);
    button.setAttribute("aria-disabled", String(Boolean(button.title)));
  }
  by("take").hidden = mine;
  by("take").textContent = words(taken ? "Take it away" : "Take the command");
  by("take").setAttribute("aria-disabled", String(authority.role === "watch" || (taken && authority.role !== "maintain")));
  by("give").hidden = !mine;
  const drivers = authority.pages.filter((page) => page.number !== authority.you && page.role !== "watch");
  const others = drivers.map((page) => `${page.number} ${page.name}`);
  by("hand-over").hidden = !mine || !others.length;
  if (others.join() !== Array.from(by("other").options, (option) => option.text).join()) {
    by("other").replaceChildren(...others.map((text) => new Option(text, text.split(" ")[0])));
  }
  for (const [id, at] of [["linear", 0], ["angular", 1], ["lateral", 2]]) {
    const edited = document.activeElement === by(id);
    if (first || (!edited && value(id) !== authority.chosen[at])) by(id).value = number(authority.chosen[at]);
    by(id).max = authority.limits[at];
  }
  by("heartbeat").checked = authority.heartbeat;
});

by("take").addEventListener("click", () => send({ type: "take", force: authority.commander !== null }));
by("give").addEventListener("click", () => send({ type: "give_back" }));
by("hand").addEventListener("click", () => send({ type: "hand_over", to: Number(by("other").value) }));
by("heartbeat").addEventListener("change", () => send({ type: "heartbeat", on: by("heartbeat").checked }));
const SPEEDS = ["linear", "angular", "lateral"];
for (const id of SPEEDS) {
  const chosen = () => Object.fromEntries(SPEEDS.map((name) => [name, value(name)]));
  by(id).addEventListener("change", () => send({ type: "speeds", ...chosen() }));
}

by("e-stop").addEventListener("click", async () => {
  release();
  try {
    const signal = AbortSignal.timeout(E_STOP_LIMIT);
    const answer = await fetch("/api/e_stop", { method: "POST", keepalive: true, signal });
    const { confirmed, text } = answer.ok ? await answer.json() : { confirmed: false, text: await answer.text() };
    say(`${confirmed ? "emergency stop confirmed" : "EMERGENCY STOP NOT CONFIRMED"}: ${text}`);
  } catch {
    say("EMERGENCY STOP NOT CONFIRMED: the console does not answer; press the button on the robot");
  }
});

function confirmReset(text) {
  const { causes = [], refusal = [] } = robot?.safety ?? {}, active = causes.filter((cause) => cause.active);
  const reasons = [...active.map((cause) => `${cause.sentence}: ${cause.remedy}`), ...refusal];
  key = text;
  const none = "Nothing prevents it. Check the robot first.";
  by("against").textContent = words(reasons.length ? `The reset is prevented by: ${reasons.join("; ")}` : none);
  by("confirm").hidden = false;
}
by("confirm-reset").addEventListener("click", async () => {
  by("confirm").hidden = true;
  say((await call("reset", { key })).text);
});
by("cancel-reset").addEventListener("click", () => { by("confirm").hidden = true; });

by("runs").addEventListener("toggle", async () => {
  if (!by("runs").open) return;
  const answer = await fetch("/api/runs").catch(() => null);
  if (answer?.ok) by("run-list").replaceChildren(...(await answer.json()).map(row));
  else say("the list of runs cannot be read");
});
function row(run) {
  const line = document.createElement("tr"), time = new Date(1000 * run.time).toLocaleString();
  for (const text of [`${run.name}, ${time}`, `${number(run.bytes / 1e6, 1)} MB`]) line.insertCell().textContent = text;
  const links = line.insertCell();
  for (const [text, path, target] of [["report", "report", "_blank"], ["download", "file", ""]]) {
    const href = `/api/runs/${run.id}/${path}`, rel = "noopener";
    links.append(Object.assign(document.createElement("a"), { textContent: words(text), href, target, rel }), " ");
  }
  return line;
}

by("doctor").addEventListener("toggle", async () => {
  if (!by("doctor").open) return;
  const answer = await fetch("/api/doctor").catch(() => null);
  if (!answer?.ok) return say(`the machine was not examined: ${answer ? await answer.text() : "no answer"}`);
  by("finding-list").replaceChildren(...(await answer.json()).map((finding) => {
    const line = document.createElement("tr"), { verdict, name, value, why, remedy } = finding;
    line.title = why;
    for (const text of [verdict, name, remedy ? `${value}; remedy: ${remedy}` : value]) line.insertCell().textContent = text;
    return line;
  }));
});

by("logout").addEventListener("click", async () => {
  release();
  await fetch("/api/logout", { method: "POST" }).catch(() => null);
  location.assign("/login");
});
connect();
