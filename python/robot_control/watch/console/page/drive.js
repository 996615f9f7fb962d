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
const keys = new Set(), stick = { pointer: null, x: 0, y: 0, sideways: false };
const offset = () => Date.now() - performance.now();
/** Why this page released what an operator still holds; empty once that is let go, or something is held again. */
export let released = "";
let padBlocked = true, commands = false, number = 0, passed = performance.now(), awake = offset(), isHeld = false;
const area = document.getElementById("pad"), knob = document.getElementById("stick");
const clamp = (value) => Math.max(-1, Math.min(1, value || 0));

function pad() {
  const found = [...(navigator.getGamepads?.() ?? [])].find((each) => each?.connected);
  const pressed = found && ENABLE.some((button) => found.buttons[button]?.pressed);
  if (!found) padBlocked = true;        // it may come back with the button held
  else if (!pressed) padBlocked = false;
  return pressed && !padBlocked ? [-found.axes[1], -found.axes[0], -found.axes[2]] : null;
}

function held() {
  if (stick.pointer !== null) return stick.sideways ? [-stick.y, 0, -stick.x] : [-stick.y, -stick.x, 0];
  if (keys.size) return [0, 1, 2].map((axis) => [...keys].reduce((sum, key) => sum + (MOTIONS[key][axis] ?? 0), 0));
  return pad();
}

function report() {
  const motion = held(), [linear, angular, lateral] = (motion ?? [0, 0, 0]).map(clamp);
  isHeld = motion !== null;
  if (isHeld) released = "";
  document.body.dataset.held = String(isHeld && commands);
  const sent = performance.now() / 1000;
  if (commands) send({ type: "drive", number: ++number, sent, held: isHeld, linear, angular, lateral });
}

/** Releases everything; what is still held has to be released and pressed again. */
export function release() {
  keys.clear();
  stick.pointer = null;
  stick.x = stick.y = 0;
  knob.style.transform = "";
  padBlocked = true;
  report();
}

/** True if this page commands; else the page says what is missing. */
function mayDrive() {
  if (!commands) document.getElementById("dead-man").textContent = words("Take the command first.");
  return commands;
}

addEventListener("keydown", (event) => {
  if (event.code === "Escape") document.getElementById("e-stop").click();
  const typing = event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.("input, textarea, select");
  if (typing || event.repeat) return;
  if (event.code === "Space" && event.target.tagName !== "BUTTON") { event.preventDefault(); release(); }
  if (!(event.code in MOTIONS)) return;
  event.preventDefault();
  if (mayDrive()) { keys.add(event.code); report(); }
});
addEventListener("keyup", (event) => { if (keys.delete(event.code)) report(); });

area.addEventListener("pointerdown", (event) => {
  if (stick.pointer !== null || !mayDrive()) return;
  area.setPointerCapture(event.pointerId);
  stick.pointer = event.pointerId;
  move(event);
  report();
});
area.addEventListener("pointermove", move);
for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
  area.addEventListener(end, (event) => { if (event.pointerId === stick.pointer) release(); });
}
function move(event) {
  if (event.pointerId !== stick.pointer) return;
  const box = area.getBoundingClientRect(), radius = box.width / 2;
  const x = (event.clientX - box.left) / radius - 1, y = (event.clientY - box.top) / radius - 1;
  const length = Math.max(1, Math.hypot(x, y));
  const sideways = event.shiftKey || document.getElementById("sideways").checked;
  Object.assign(stick, { x: x / length, y: y / length, sideways });
  knob.style.transform = `translate(${stick.x * radius}px, ${stick.y * radius}px)`;
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
