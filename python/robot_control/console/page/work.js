// Everything that is not driving: command, reset, paths, odometry, parameters, simulation, runs.
import { on, send, call } from "/link.js";
import { release } from "/drive.js";
import { draw } from "/scene.js";
import { list, number } from "/panels.js";

const by = (id) => document.getElementById(id);
const messages = [];
let desk = null, robot = null;

export function say(text) {
  messages.unshift(`${new Date().toLocaleTimeString()} ${text}`);
  messages.length = Math.min(messages.length, 8);
  list("messages", messages);
}

on("said", ({ text }) => say(text));
document.addEventListener("hint", () => { by("hold").textContent = "Take the command first."; });

const COMPONENTS = "left_encoder right_encoder gyro accelerometer left_motor right_motor battery e_stop_button";
const KINDS = "ok off stuck garbage wrong slow delayed intermittent";
for (const [id, words] of [["component", COMPONENTS], ["kind", KINDS]]) words.split(" ").forEach((word) => by(id).add(new Option(word)));

const value = (id) => Number(by(id).value);
const ARGUMENTS = {
  path_points: async () => {
    say("draw a stroke on the grid");
    const points = await draw();
    return points.length > 1 ? { points, speed: value("path-speed") } : null;
  },
  path_shape: () => ({ shape: by("shape").value, size: value("size"), speed: value("path-speed") }),
  path_csv: async () => by("csv").files[0] ? { text: await by("csv").files[0].text(), speed: value("path-speed") } : null,
  set_odometry: () => ({ x: value("x"), y: value("y"), yaw: value("yaw") }),
  set_parameters: () => ({ parameters: by("parameters").value }),
  pause: () => ({ on: !robot?.paused }),
  step: () => ({ cycles: 100 }),
  inject_fault: () => ({ component: by("component").value, kind: by("kind").value }),
};

for (const button of document.querySelectorAll("[data-call]")) {
  button.addEventListener("click", async () => {
    const name = button.dataset.call, why = desk?.against[name];
    if (why) return say(`${button.textContent}: ${why}`);
    const args = ARGUMENTS[name] ? await ARGUMENTS[name]() : {};
    if (args === null) return say(`${button.textContent}: nothing was chosen`);
    const { accepted, text } = await call(name, args);
    say(`${button.textContent}: ${accepted ? "" : "refused: "}${text}`);
  });
}

on("slow", (slow) => {
  robot = slow;
  by("simulation").hidden = !slow.simulated;
  by("pause").textContent = slow.paused ? "Go on" : "Pause";
});

on("desk", (next) => {
  const first = !desk;
  desk = next;
  for (const button of document.querySelectorAll("[data-call]")) {
    const why = desk.against[button.dataset.call];
    button.setAttribute("aria-disabled", String(Boolean(why)));
    button.title = why;
  }
  const mine = desk.commander === desk.you, taken = desk.commander !== null && !mine;
  by("take").textContent = taken ? "Take it away" : "Take the command";
  by("take").setAttribute("aria-disabled", String(mine || desk.role === "watch" || (taken && desk.role !== "maintain")));
  by("give").setAttribute("aria-disabled", String(!mine));
  by("hand").setAttribute("aria-disabled", String(!mine));
  by("reset").setAttribute("aria-disabled", String(Boolean(desk.against.reset)));
  by("reset").title = desk.against.reset;
  const others = desk.pages.filter((page) => page.number !== desk.you && page.role !== "watch").map((page) => `${page.number} ${page.name}`);
  const shown = [...by("other").options].map((option) => option.text);
  if (others.join() !== shown.join()) by("other").replaceChildren(...others.map((text) => new Option(text, text.split(" ")[0])));
  for (const [id, at] of [["linear", 0], ["angular", 1]]) {
    if (first || (document.activeElement !== by(id) && value(id) !== desk.chosen[at])) by(id).value = number(desk.chosen[at]);
    by(id).max = desk.limits[at];
  }
  by("heartbeat").checked = desk.heartbeat;
});

by("take").addEventListener("click", () => send({ type: "take", force: desk.commander !== null }));
by("give").addEventListener("click", () => send({ type: "give_back" }));
by("hand").addEventListener("click", () => by("other").value ? send({ type: "hand_over", to: Number(by("other").value) }) : say("there is no other page that may drive"));
by("heartbeat").addEventListener("change", () => send({ type: "heartbeat", on: by("heartbeat").checked }));
for (const id of ["linear", "angular"]) {
  by(id).addEventListener("change", () => send({ type: "speeds", linear: value("linear"), angular: value("angular") }));
}

by("e-stop").addEventListener("click", async () => {
  release();
  try {
    const answer = await fetch("/api/e_stop", { method: "POST", keepalive: true });
    say(answer.ok ? "the emergency stop was requested" : `EMERGENCY STOP NOT SENT: ${await answer.text()}`);
  } catch {
    say("EMERGENCY STOP NOT SENT: the console does not answer; use the button on the robot");
  }
});

let key = "";
by("reset").addEventListener("click", async () => {
  if (desk?.against.reset) return say(`Reset: ${desk.against.reset}`);
  const { accepted, text } = await call("reset_asked");
  if (!accepted) return say(`Reset: ${text}`);
  key = text;
  const active = (robot?.safety?.causes ?? []).filter((cause) => cause.active).map((cause) => `${cause.sentence}: ${cause.remedy}`);
  const refused = robot?.safety?.refusal ?? [];
  by("against").textContent = active.length || refused.length ? `Against it stands: ${[...active, ...refused].join("; ")}` : "Nothing stands against it. Look at the robot first.";
  by("confirm").hidden = false;
});
by("confirm-reset").addEventListener("click", async () => {
  by("confirm").hidden = true;
  const { text } = await call("reset", { key });
  say(text);
});
by("cancel-reset").addEventListener("click", () => { by("confirm").hidden = true; });

by("runs").addEventListener("toggle", async () => {
  if (!by("runs").open) return;
  const answer = await fetch("/api/runs").catch(() => null);
  if (!answer?.ok) return say("the list of runs cannot be read");
  by("run-list").replaceChildren(...(await answer.json()).map(row));
});
function row(run) {
  const line = document.createElement("tr");
  const name = line.insertCell(), size = line.insertCell(), links = line.insertCell();
  name.textContent = `${run.name}, ${new Date(1000 * run.time).toLocaleString()}`;
  size.textContent = `${number(run.bytes / 1e6, 1)} MB`;
  for (const [text, path] of [["report", "report"], ["download", "file"]]) {
    const link = document.createElement("a");
    link.textContent = text;
    link.href = `/api/runs/${run.id}/${path}`;
    link.target = path === "report" ? "_blank" : "";
    link.rel = "noopener";
    links.append(link, " ");
  }
  return line;
}

by("logout").addEventListener("click", async () => {
  release();
  await fetch("/api/logout", { method: "POST" }).catch(() => null);
  location.assign("/login");
});
