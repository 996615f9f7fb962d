// Values → words. Text of the robot, of users and of files enters the page by textContent alone.
import { on, silent } from "/link.js";

const by = (id) => document.getElementById(id);
const SIGNS = { moving: "▶", idle: "◆", stopped: "■" };       // readable without colour
const AGES = { limited: 1, odom: 1, truth: 1, drive: 1 };      // s, after which a topic is silent
let frame = {}, slowAt = -Infinity;

export const number = (value, digits = 2) => typeof value === "number" ? (value + 0).toFixed(digits) : "–";
const put = (id, text) => { if (by(id).textContent !== text) by(id).textContent = text; };

export function list(id, texts) {
  const parent = by(id);
  while (parent.children.length > texts.length) parent.lastChild.remove();
  texts.forEach((text, i) => {
    const item = parent.children[i] ?? parent.appendChild(document.createElement("li"));
    if (item.textContent !== text) item.textContent = text;
  });
}

on("fast", (message) => {
  frame = message;
  for (const name of ["asked", "limited", "measured", "true"]) {
    put(`${name}-v`, number(message[name]?.[0]));
    put(`${name}-w`, number(message[name]?.[1]));
  }
  const [x, y, yaw] = message.pose ?? [];
  put("pose", `${number(x)} m, ${number(y)} m, ${number(yaw)} rad`);
  document.body.dataset.frames = String(Number(document.body.dataset.frames ?? 0) + 1);
});

on("slow", (slow) => {
  slowAt = performance.now();
  document.body.dataset.verdict = slow.verdict;
  document.body.dataset.state = slow.safety?.state ?? "";
  put("sign", SIGNS[slow.verdict]);
  put("state", slow.safety ? slow.safety.state : "no safety_status");
  put("headline", slow.headline);
  const causes = slow.safety?.causes ?? [];
  list("causes", causes.map((cause) => `${cause.first ? "first: " : ""}${cause.sentence}${cause.detail ? ` (${cause.detail})` : ""}${cause.active ? ", still true" : ""}`));
  list("actions", [...slow.actions.map(([actor, text]) => actor ? `${actor}: ${text}` : text), ...slow.commands.map((text) => `$ ${text}`)]);
  list("reasons", [...slow.reasons.map((text) => `limited: ${text}`), ...(slow.safety?.warnings ?? []).map((text) => `warning: ${text}`), ...slow.estimate.map((text) => `odometry: ${text}`)]);
  put("senders", slow.senders.join(", ") || "no node");
  list("sources", [...slow.sources, ...slow.revoked.map((name) => `${name}: revoked, has to send zero`)]);
  put("nodes", Object.entries(slow.nodes).map(([name, there]) => `${there ? "●" : "○"} ${name}${there ? "" : " (silent)"}`).join("  "));
  put("faults", slow.faults && slow.faults !== "none" ? `injected: ${slow.faults}` : "");
  const path = slow.path;
  put("progress", path && path.age < 3 ? `${path.state}${path.reason ? `: ${path.reason}` : ""}, ${number(100 * path.progress, 0)} %, ${number(path.remaining_distance)} m left, ${number(1000 * path.cross_track_error, 0)} mm beside` : "no path");
  const master = slow.master ? "" : "The ROS master does not answer: nothing new connects.";
  const missing = slow.missing.length ? `Not running: ${slow.missing.join(", ")}.` : "";
  by("banner").dataset.robot = [master, missing].filter(Boolean).join(" ");
});

on("desk", (desk) => {
  const holder = desk.pages.find((page) => page.number === desk.commander);
  const mine = desk.commander === desk.you;
  put("who", mine ? "This page commands." : holder ? `${holder.name} (page ${holder.number}) commands.` : "No page commands.");
  put("hold", desk.hold);
  list("pages", desk.pages.map((page) => `${page.name}, page ${page.number}, ${page.role}${page.number === desk.you ? ", this one" : ""}${page.number === desk.commander ? ", commands" : ""}`));
  const ms = (value) => value === null ? "–" : number(1000 * value, 0);
  const link = desk.link;
  put("link", `${ms(link.last)} ms, 95 % within ${ms(link.p95)} ms, ${link.gaps} gaps, ${link.late} late; allows ${number(link.cap)} m/s`);
  put("role", `role: ${desk.role}`);
});

setInterval(() => {
  const dead = silent(), banner = by("banner");
  document.body.dataset.link = dead ? "silent" : "open";
  const text = dead ? "No connection to the console: everything below is old, and nothing is commanded." : banner.dataset.robot ?? "";
  if (banner.textContent !== text) banner.textContent = text;
  banner.hidden = !text;
  document.querySelector("main").classList.toggle("dead", dead);
  for (const element of document.querySelectorAll("[data-topic]")) {
    const age = frame.ages?.[element.dataset.topic];
    element.classList.toggle("stale", dead || typeof age !== "number" || age > AGES[element.dataset.topic]);
  }
  const old = dead || performance.now() - slowAt > 3000;
  for (const id of ["verdict", "why", "commanders", "who", "hold", "link", "asked"]) by(id).classList.toggle("stale", old);
}, 200);
