// The bar: who the robot is, how it is in one word and in one sentence, its link, battery and who has control.
import { by, number, put, show } from "/dom.js";
import { on, onRead, silent } from "/link.js";
import { words } from "/words.js";

const STATE_SILENCE = 3000, LOOK = 200;            // ms
const DRIVABLE = ["READY", "DRIVE"];
const GOOD = 0.06, FAIR = 0.2;                     // s of round trip, 95 %
const STEADY = 4;                                  // states in a row that count as limited, for a ramp limits as well
const STANDS = 0.01, BESIDE = 0.02;                // m/s and rad/s; the difference that counts as limited
let slowAt = -Infinity, banner = "", frame = {}, frames = 0, limited = 0;

on("fast", (values) => {
  frame = values;
  const { measured } = values, stands = measured && Math.max(...measured.map(Math.abs)) < STANDS;
  if (document.body.dataset.moving !== String(!stands)) document.body.dataset.moving = String(!stands);
  ++frames;
});
onRead("fast", () => {
  document.body.dataset.frames = String(frames);
});

function isLimited({ limits, safety }) {
  if (safety?.warnings?.length) return true;
  const { asked, limited: after } = frame;
  const less = asked && after && asked.some((value, i) => Math.abs(value - after[i]) > BESIDE);
  limited = limits.length && less ? limited + 1 : 0;
  return limited >= STEADY;
}

/** How the robot is, for colours: stopped, waiting, limited, moving, ready. */
function lookOf(slow) {
  if (slow.verdict === "stopped") return slow.safety?.causes.length ? "stopped" : "waiting";
  if (isLimited(slow)) return "limited";
  return slow.verdict === "moving" ? "moving" : "ready";
}

function wordOf(look, { safety, paused, legged }) {
  if (look === "stopped") return safety.state;
  if (look === "waiting") return paused ? "PAUSED" : safety ? "NOT READY" : "NO ROBOT";
  if (look === "moving") return legged && frame.legs?.posture === "walking" ? "WALKING" : "MOVING";
  return look === "limited" ? "LIMITED" : "READY";
}

on("slow", (slow) => {
  slowAt = performance.now();
  const { safety, legged, battery } = slow, look = lookOf(slow);
  Object.assign(document.body.dataset, {
    verdict: slow.verdict, legged: String(legged), look, state: safety?.state ?? "",
    drivable: String(DRIVABLE.includes(safety?.state)),
  });
  put("state", wordOf(look, slow));
  const why = look === "limited" && (slow.limits[0] ?? safety?.warnings[0]);
  put("headline", why ? `${slow.sentence} ${words(`limited: ${why}`)}` : slow.sentence);
  by("sentence").title = words(slow.headline);
  const [share, volts] = battery ?? [];
  by("battery-chip").hidden = typeof share !== "number" && typeof volts !== "number";
  show(by("battery"), typeof share === "number" ? `${number(100 * share, 0)} %` : `${number(volts, 1)} V`);
  put("mode", legged ? frame.legs?.gait || frame.legs?.posture || "" : "");
  const master = slow.master ? "" : "The ROS master does not answer: nothing new connects.";
  const [source] = Object.keys(slow.broken);
  banner = master || (source ? `A source is broken: ${source}. Its messages cannot be read.` : "");
});

on("authority", (authority) => {
  const { link, commander } = authority, page = authority.pages.find((each) => each.number === commander);
  const ms = (value) => value === null ? "–" : `${number(1000 * value, 0)} ms`;
  put("who", commander === authority.you ? "you" : page?.name ?? "free");
  show(by("link-ms"), ms(link.p95));
  by("link-chip").dataset.bars = link.p95 === null ? 0 : link.p95 < GOOD ? 3 : link.p95 < FAIR ? 2 : 1;
  const counts = `gaps: ${link.gaps}, late: ${link.late}`;
  put("link", `${ms(link.last)}, 95 % within ${ms(link.p95)}; ${counts}; allows ${number(link.cap)} m/s`);
});

by("link-chip").addEventListener("click", () => {
  by("link-card").hidden = !by("link-card").hidden;
  by("link-chip").setAttribute("aria-expanded", String(!by("link-card").hidden));
});

setInterval(() => {
  const dead = silent(), old = performance.now() - slowAt > STATE_SILENCE;
  document.body.dataset.link = dead ? "silent" : "open";
  if (dead) {
    Object.assign(document.body.dataset, { look: "off", moving: "true" });
    put("state", Number(document.body.dataset.frames ?? 0) ? "NO CONNECTION" : "connecting");
    put("headline", "");
    by("link-chip").dataset.bars = 0;
    show(by("link-ms"), "–");
  }
  const lost = "No connection to the console. Nothing is commanded.";
  const text = dead && document.body.dataset.frames ? lost : old && !dead ? "No state of the robot is received." : banner;
  put("banner", text);
  by("banner").dataset.kind = dead ? "lost" : "warn";
  by("banner").hidden = !text;
}, LOOK);
