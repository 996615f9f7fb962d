// Keys, stick and pad → what is held. Whatever takes this page's attention away releases all of it at once.
import { on, send, reconnect } from "/link.js";
import { words } from "/words.js";

const PERIOD = 50;       // ms between two messages while this page commands
const FROZEN = 300;      // ms between two passes, after which this page stood still
const ASLEEP = 1000;     // ms that the time of day went on while the page's clock, which the server compares, stood
const ENABLE = [4, 5];   // shoulder buttons of the standard mapping
const MOTIONS = {        // forward, turning to the left, sideways to the left
  KeyW: [1, 0], ArrowUp: [1, 0], KeyS: [-1, 0], ArrowDown: [-1, 0], KeyA: [0, 1], ArrowLeft: [0, 1],
  KeyD: [0, -1], ArrowRight: [0, -1], KeyQ: [1, 1], KeyE: [1, -1], KeyZ: [-1, -1], KeyC: [-1, 1],
  KeyJ: [0, 0, 1], KeyL: [0, 0, -1],
};
const keys = new Set();
const offset = () => Date.now() - performance.now();
/** Why this page released what an operator still holds; empty once that is let go, or something is held again. */
export let released = "";
let padBlocked = true, commands = false, number = 0, passed = performance.now(), awake = offset(), isHeld = false;
const by = (id) => document.getElementById(id);
const stick = (id) => ({ area: by(id), knob: by(id).querySelector("div"), pointer: null, x: 0, y: 0, sideways: false });
const left = stick("pad"), right = stick("pad-turn"), sticks = [left, right];
const clamp = (value) => Math.max(-1, Math.min(1, value || 0));

function pad() {
  const found = [...(navigator.getGamepads?.() ?? [])].find((each) => each?.connected);
  const pressed = found && ENABLE.some((button) => found.buttons[button]?.pressed);
  if (!found) padBlocked = true;        // it may come back with the button held
  else if (!pressed) padBlocked = false;
  return pressed && !padBlocked ? [-found.axes[1], -found.axes[0], -found.axes[2]] : null;
}

const two = () => right.area.offsetParent !== null;  // on a phone on its side the right one turns

function held() {
  if (sticks.some(({ pointer }) => pointer !== null)) {
    return left.sideways || two() ? [-left.y, -right.x, -left.x] : [-left.y, -left.x, 0];
  }
  if (keys.size) return [0, 1, 2].map((axis) => [...keys].reduce((sum, key) => sum + (MOTIONS[key][axis] ?? 0), 0));
  return pad();
}

/** The knobs show what is held, with whatever it is held. */
function deflect([linear, angular, lateral]) {
  const places = [[left, -(two() ? lateral : angular || lateral), -linear], [right, -angular, 0]];
  for (const [{ knob }, x, y] of places) {
    const length = Math.max(1, Math.hypot(x, y));
    knob.style.setProperty("--x", x / length);
    knob.style.setProperty("--y", y / length);
  }
}

function report() {
  const motion = held(), [linear, angular, lateral] = (motion ?? [0, 0, 0]).map(clamp);
  isHeld = motion !== null;
  deflect([linear, angular, lateral]);
  if (isHeld) released = "";
  document.body.dataset.held = String(isHeld && commands);
  const sent = performance.now() / 1000;
  if (commands) send({ type: "drive", number: ++number, sent, held: isHeld, linear, angular, lateral });
}

/** Releases everything; what is still held has to be released and pressed again. */
export function release() {
  keys.clear();
  sticks.forEach(centre);
  padBlocked = true;
  report();
}

function centre(one) {
  Object.assign(one, { pointer: null, x: 0, y: 0 });
}

/** True if this page commands; else the page says what is missing. */
function mayDrive() {
  if (!commands) by("dead-man").textContent = words("Take control first.");
  return commands;
}

// What is open over the stage takes Esc first, but only while the robot is known to stand.
const closes = () => document.body.dataset.moving === "false" && document.querySelector("#help:not([hidden]), #view.drawing");

addEventListener("keydown", (event) => {
  if (event.code === "Escape" && !closes()) by("e-stop").click();
  const typing = event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.("input, textarea, select");
  if (typing || event.repeat) return;
  if (event.code === "Space" && event.target.tagName !== "BUTTON") { event.preventDefault(); release(); }
  if (!(event.code in MOTIONS)) return;
  event.preventDefault();
  if (mayDrive()) { keys.add(event.code); report(); }
});
addEventListener("keyup", (event) => { if (keys.delete(event.code)) report(); });

for (const one of sticks) {
  one.area.addEventListener("pointerdown", (event) => {
    if (one.pointer !== null || event.target.tagName === "BUTTON" || !mayDrive()) return;
    one.area.setPointerCapture(event.pointerId);
    one.pointer = event.pointerId;
    move(one, event);
    report();
  });
  one.area.addEventListener("pointermove", (event) => {
    move(one, event);
    if (event.pointerId === one.pointer) deflect(held());
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
    one.area.addEventListener(end, (event) => {
      if (event.pointerId !== one.pointer) return;
      if (end !== "pointerup") return release();
      centre(one);
      report();
    });
  }
}
function move(one, event) {
  if (event.pointerId !== one.pointer) return;
  const box = one.area.getBoundingClientRect(), radius = box.width / 2;
  const x = (event.clientX - box.left) / radius - 1, y = (event.clientY - box.top) / radius - 1;
  const length = Math.max(1, Math.hypot(x, y));
  const sideways = event.shiftKey || by("sideways").checked;
  Object.assign(one, { x: x / length, y: y / length, sideways });
}

for (const end of ["keyup", "pointerup"]) addEventListener(end, () => { released = ""; });
for (const event of ["blur", "pagehide", "freeze", "gamepaddisconnected"]) addEventListener(event, release);
for (const event of ["freeze", "visibilitychange"]) document.addEventListener(event, release);
addEventListener("contextmenu", (event) => { if (isHeld) { event.preventDefault(); release(); } });
on("closed", () => { commands = false; release(); });
on("authority", (authority) => {
  const mine = authority.commander === authority.you;
  if (mine !== commands) { commands = mine; release(); }
  document.body.dataset.commands = String(mine);
});

setInterval(() => {
  const now = performance.now(), still = now - passed;
  passed = now;
  if (document.hidden) return;
  if (Math.abs(offset() - awake) > ASLEEP) reconnect();
  awake = offset();
  if (still <= FROZEN) return report();
  const wasHeld = isHeld;
  release();
  if (wasHeld) released = `This page stood still for ${still.toFixed(0)} ms: release what you hold, and press again.`;
}, PERIOD);
