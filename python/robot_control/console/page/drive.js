// Keys, stick and pad → what is held. Whatever takes this page's attention away releases all of it at once.
import { on, send, reconnect } from "/link.js";

const PERIOD = 50;       // ms between two messages while this page commands
const FROZEN = 300;      // ms between two passes, after which this page stood still
const ASLEEP = 1000;     // ms that the time of day went on while the page's clock, which the server compares, stood
const DEAD_ZONE = 0.1;   // share of a pad's axis
const ENABLE = [4, 5];   // shoulder buttons of the standard mapping
const MOTIONS = {        // forward, to the left
  KeyW: [1, 0], ArrowUp: [1, 0], KeyS: [-1, 0], ArrowDown: [-1, 0], KeyA: [0, 1], ArrowLeft: [0, 1],
  KeyD: [0, -1], ArrowRight: [0, -1], KeyQ: [1, 1], KeyE: [1, -1], KeyZ: [-1, -1], KeyC: [-1, 1],
};
const keys = new Set();
const stick = { pointer: null, x: 0, y: 0 };
const offset = () => Date.now() - performance.now();
let padBlocked = true, commands = false, number = 0, passed = performance.now(), wasHeld = false, awake = offset();
const area = document.getElementById("pad"), knob = document.getElementById("stick");

const clamp = (value) => Math.max(-1, Math.min(1, value));
const zoned = (value) => Math.abs(value) < DEAD_ZONE ? 0 : clamp(value);

function pad() {
  const found = [...(navigator.getGamepads?.() ?? [])].find((each) => each?.connected);
  const pressed = found && ENABLE.some((button) => found.buttons[button]?.pressed);
  if (!found) padBlocked = true;        // it may come back with the button held
  else if (!pressed) padBlocked = false;
  return pressed && !padBlocked ? [zoned(-found.axes[1] || 0), zoned(-found.axes[0] || 0)] : null;
}

function held() {
  if (stick.pointer !== null) return [-stick.y, -stick.x];
  if (keys.size) {
    const sum = [...keys].reduce(([a, b], key) => [a + MOTIONS[key][0], b + MOTIONS[key][1]], [0, 0]);
    return sum.map(clamp);
  }
  return pad();
}

function report() {
  const motion = held();
  document.body.dataset.held = String(motion !== null && commands);
  wasHeld = motion !== null;
  if (!commands) return;
  const [linear, angular] = motion ?? [0, 0];
  send({ type: "drive", number: ++number, sent: performance.now() / 1000, held: motion !== null, linear, angular });
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

function typing(event) {
  return event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.("input, textarea, select");
}

addEventListener("keydown", (event) => {
  if (event.code === "Escape") document.getElementById("e-stop").click();
  if (typing(event) || event.repeat) return;
  if (event.code === "Space" && event.target.tagName !== "BUTTON") { event.preventDefault(); release(); }
  if (!(event.code in MOTIONS)) return;
  event.preventDefault();
  if (!commands) return void document.dispatchEvent(new CustomEvent("hint"));
  keys.add(event.code);
  report();
});
addEventListener("keyup", (event) => { if (keys.delete(event.code)) report(); });

area.addEventListener("pointerdown", (event) => {
  if (stick.pointer !== null) return;
  if (!commands) return void document.dispatchEvent(new CustomEvent("hint"));
  area.setPointerCapture(event.pointerId);
  stick.pointer = event.pointerId;
  move(event);
  report();
});
area.addEventListener("pointermove", (event) => { if (event.pointerId === stick.pointer) move(event); });
for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
  area.addEventListener(end, (event) => { if (event.pointerId === stick.pointer) release(); });
}
function move(event) {
  const box = area.getBoundingClientRect(), radius = box.width / 2;
  let x = (event.clientX - box.left) / radius - 1, y = (event.clientY - box.top) / radius - 1;
  const length = Math.max(1, Math.hypot(x, y));
  stick.x = zoned(x / length); stick.y = zoned(y / length);
  knob.style.transform = `translate(${stick.x * radius}px, ${stick.y * radius}px)`;
}

for (const lost of ["blur", "pagehide", "freeze"]) addEventListener(lost, release);
document.addEventListener("freeze", release);
document.addEventListener("visibilitychange", release);
addEventListener("gamepaddisconnected", release);
addEventListener("contextmenu", (event) => { if (wasHeld) { event.preventDefault(); release(); } });
on("closed", () => { commands = false; release(); });
on("desk", (desk) => {
  const mine = desk.commander === desk.you;
  if (mine !== commands) { commands = mine; release(); }
  document.body.dataset.commands = String(mine);
});

setInterval(() => {
  const now = performance.now(), still = now - passed;
  passed = now;
  if (document.hidden) return;
  if (Math.abs(offset() - awake) > ASLEEP) reconnect();
  awake = offset();
  if (still > FROZEN) release();
  else report();
}, PERIOD);
