// Values → words. Text of the robot, of users and of files enters the page by textContent alone.
import { released } from "/drive.js";
import { on, silent } from "/link.js";
import { words } from "/words.js";

export const by = (id) => document.getElementById(id);
const SIGNS = { moving: "▶", idle: "◆", stopped: "■" };  // readable without colour
const TOPIC_SILENCE = 1, STATE_SILENCE = 3000;            // s, ms
const DRIVABLE = ["READY", "DRIVE"], TALKS = 3;           // s for which a report of follow_path counts
let ages = {}, slowAt = -Infinity, robotBanner = "";

export function number(value, digits = 2) {
  const text = typeof value === "number" ? value.toFixed(digits) : "–";
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}
const put = (id, text) => show(by(id), words(text));
const show = (element, text) => { if (element.textContent !== text) element.textContent = text; };

export function list(id, texts) {
  const parent = by(id);
  while (parent.children.length > texts.length) parent.lastChild.remove();
  texts.forEach((text, i) => {
    show(parent.children[i] ?? parent.appendChild(document.createElement("li")), words(text));
  });
}

on("fast", (frame) => {
  ages = frame.ages;
  for (const name of ["asked", "limited", "measured", "true"]) {
    put(`${name}-v`, number(frame[name]?.[0]));
    put(`${name}-w`, number(frame[name]?.[1]));
    put(`${name}-l`, number(frame[name]?.[2]));
  }
  const [x, y, yaw] = frame.pose ?? [];
  show(by("pose"), `${number(x)} m, ${number(y)} m, ${number(yaw)} rad`);
  if (frame.legs) legs(frame.legs);
  document.body.dataset.frames = String(Number(document.body.dataset.frames ?? 0) + 1);
});

function legs({ posture, gait, chosen, gaits, feet }) {
  while (by("gait").children.length < gaits.length) by("gait").append(new Option(gaits[by("gait").children.length]));
  const whose = chosen === "auto" ? "by the speed" : "chosen";
  put("posture", gait ? `${posture}, ${gait} (${whose})` : `${posture}, gait: ${chosen}`);
  while (by("feet").children.length < feet.length) by("feet").append(document.createElement("span"));
  feet.forEach(({ name, bears, load }, i) => {
    show(by("feet").children[i], `${bears ? "●" : "○"} ${words(name.replace("_", " "))} ${number(load, 0)} N`);
  });
}

on("slow", (slow) => {
  slowAt = performance.now();
  const safety = slow.safety, causes = safety?.causes ?? [], path = slow.path;
  document.body.dataset.verdict = slow.verdict;
  document.body.dataset.legged = String(slow.legged);
  document.body.dataset.state = safety?.state ?? "";
  document.body.dataset.drivable = String(DRIVABLE.includes(safety?.state));
  put("sign", SIGNS[slow.verdict]);
  put("state", safety?.state ?? "no safety_status");
  put("headline", slow.headline);
  list("causes", causes.map(({ first, sentence, detail, active }) =>
    `${first ? "first: " : ""}${sentence}${detail ? ` (${detail})` : ""}${active ? ", still true" : ""}`));
  const actions = slow.actions.map(([actor, text]) => actor ? `${actor}: ${text}` : text);
  list("actions", [...actions, ...slow.commands.map((text) => `$ ${text}`)]);
  const notes = { limited: slow.limits, warning: safety?.warnings ?? [], odometry: slow.odometry };
  list("reasons", Object.entries(notes).flatMap(([kind, texts]) => texts.map((text) => `${kind}: ${text}`)));
  put("senders", slow.senders.join(", ") || "no node");
  list("sources", [...slow.sources, ...slow.revoked.map((name) => `${name}: revoked, has to send zero`)]);
  list("nodes", Object.entries(slow.nodes).map(([name, there]) => there ? `● ${name}` : `○ ${name} (silent)`));
  put("faults", slow.faults && slow.faults !== "none" ? `injected: ${slow.faults}` : "");
  put("data-return", slow.data_return && `data return: ${slow.data_return}`);
  put("goal-state", slow.goal ? `goal: ${slow.goal}` : "navigate does not run");
  put("progress", path.age === null || path.age >= TALKS ? "no path" : [
    path.reason ? `${path.state}: ${path.reason}` : path.state, `${number(100 * path.progress, 0)} %`,
    `${number(path.remaining_distance)} m left`, `${number(1000 * path.cross_track_error, 0)} mm beside`,
  ].join(", "));
  const master = slow.master ? "" : "The ROS master does not answer: nothing new connects. ";
  robotBanner = master + (slow.missing.length ? `Not running: ${slow.missing.join(", ")}.` : "");
});

on("authority", (authority) => {
  const commander = authority.pages.find((page) => page.number === authority.commander), { link } = authority;
  const ms = (value) => value === null ? "–" : `${number(1000 * value, 0)} ms`;
  const other = commander ? `${commander.name} (page ${commander.number}) commands.` : "No page commands.";
  put("who", authority.commander === authority.you ? "This page commands." : other);
  put("dead-man", authority.dead_man || released);
  list("pages", authority.pages.map(({ name, number: page, role }) =>
    [name, `page ${page}`, role, page === authority.you && "this one", page === authority.commander && "commands"]
      .filter(Boolean).join(", ")));
  const counts = `gaps: ${link.gaps}, late: ${link.late}`;
  put("link", `${ms(link.last)}, 95 % within ${ms(link.p95)}; ${counts}; allows ${number(link.cap)} m/s`);
  put("role", `role: ${authority.role}`);
});

setInterval(() => {
  const dead = silent(), old = dead || performance.now() - slowAt > STATE_SILENCE;
  const noConnection = "No connection to the console: everything below is old, and nothing is commanded.";
  const text = dead ? noConnection : robotBanner.trim();
  document.body.dataset.link = dead ? "silent" : "open";
  put("banner", text);
  if (dead) { put("who", "No connection."); put("dead-man", ""); }
  by("banner").hidden = !text;
  for (const element of document.querySelectorAll("[data-topic]")) {
    const age = ages[element.dataset.topic];
    element.classList.toggle("stale", dead || typeof age !== "number" || age > TOPIC_SILENCE);
  }
  for (const id of ["verdict", "why", "commanders", "link", "asked"]) by(id).classList.toggle("stale", old);
}, 200);
