// Speeds, torques, errors and link over time. Their memory is fixed, and they rest while nobody can see them.
import { by, make } from "/dom.js";
import { on } from "/link.js";
import { Plot, Signal } from "/plot.js";
import { KINDS } from "/speed.js";
import { tab } from "/tabs.js";
import { words } from "/words.js";

const STEP = 0.1, LONGEST = 120, SIZE = LONGEST / STEP, SPANS = [10, 20, 60, 120], MINI = 20;  // s
const LATE = 1;  // s after which the server counts a topic as silent, too
const REDRAW = 250, TIMES = 100, KEY = "console-plots";  // ms, redraws that are remembered
const LEAST = { "m/s": 0.2, "rad/s": 0.3, "N·m": 2, rad: 0.05, ms: 20 };  // of a vertical axis
const HUES = [215, 25, 150, 285, 55, 340, 190, 100];       // one for each leg, or each wheel
const DASHES = [null, [7, 3], [2, 3], [9, 3, 2, 3]];       // one for each joint of a leg
const plots = new Map(), times = [];
let newest = SIZE - 1, last = -Infinity, drawn = -Infinity, link = {}, span = 20, paused = false, off = new Set();
try { off = new Set(JSON.parse(localStorage.getItem(KEY)) ?? []); } catch { /* what is stored is none */ }

const mini = new Plot(by("mini-plot"), { title: "Speed, last 20 s", unit: "m/s", least: LEAST["m/s"], labels: false });

function plotOf(name, unit, group = "") {
  if (!plots.has(name)) {
    const plot = new Plot(by("plots"), { title: name, unit, least: LEAST[unit] });
    Object.assign(plot, { group });
    plots.set(name, plot);
    chooser(name, plot);
  }
  return plots.get(name);
}

function chooser(name, plot) {
  const button = make("button", { textContent: words(name) });
  const apply = () => {
    plot.element.hidden = off.has(name);
    button.setAttribute("aria-pressed", String(!off.has(name)));
  };
  button.addEventListener("click", () => {
    if (!off.delete(name)) off.add(name);
    try { localStorage.setItem(KEY, JSON.stringify([...off])); } catch { /* forgotten with the page */ }
    apply();
    draw();
  });
  by("signals").append(button);
  apply();
}

function add(plot, key, label, style, value) {
  let signal = plot.signals.find((each) => each.key === key);
  if (!signal) {
    signal = Object.assign(new Signal(label, style, SIZE), { key });
    plot.signals.push(signal);
  }
  signal.next = value ?? NaN;
}

/** The leg or the side of a joint, and what is left of its name. */
function partsOf(name) {
  const found = /^((?:front|rear|left|right|fl|fr|rl|rr|middle)(?:_(?:left|right|front|rear|middle))?)_(.*)$/.exec(name);
  return found ? [found[1], found[2].replace(/_joint$/, "") || found[1]] : ["joints", name.replace(/_joint$/, "")];
}

function joints(driven, of, title, unit) {
  const groups = [...new Set(driven.map(({ name }) => partsOf(name)[0]))];
  const whole = driven.length <= 2 * groups.length && groups.length <= 4;  // wheels share one plot, legs have one each
  driven.forEach((joint) => {
    const [group, rest] = partsOf(joint.name), within = driven.filter(({ name }) => partsOf(name)[0] === group);
    const hue = whole ? groups.indexOf(group) : within.indexOf(joint), dash = whole ? within.indexOf(joint) : 0;
    const colour = `hsl(${HUES[hue % HUES.length]} 75% ${matchMedia("(prefers-color-scheme: dark)").matches ? 65 : 42}%)`;
    const plot = plotOf(whole ? title : `${title}, ${group.replace("_", " ")}`, unit);
    add(plot, joint.name, whole ? `${group.replace("_", " ")} ${rest}` : rest, { colour, dash: DASHES[dash % 4] }, joint[of]);
  });
}

on("authority", (authority) => { link = authority.link; });
on("fast", (frame) => {
  const now = performance.now(), ms = (value) => typeof value === "number" ? 1000 * value : NaN;
  if (paused || now - last < 1000 * STEP * 0.9) return;
  const skipped = Number.isFinite(last) ? Math.min(SIZE, Math.round((now - last) / (1000 * STEP))) : 1;
  last = now;
  for (const plot of plots.values()) for (const signal of plot.signals) signal.next = NaN;
  for (const [at, [title, unit]] of [["speed", "m/s"], ["turn rate", "rad/s"]].entries()) {
    for (const name of KINDS) {
      const dash = name === "asked" ? [5, 3] : null;
      add(plotOf(title, unit), name, name, { token: name, dash }, frame[name]?.[at]);
    }
  }
  const error = frame.legs ? ["error of joints", "rad"] : ["error of wheels", "rad/s"];
  joints(frame.driven ?? [], "effort", "torque", "N·m");
  if (frame.driven) joints(frame.driven, "error", ...error);
  add(plotOf("link", "ms"), "last", "round trip", { token: "measured" }, ms(link.last));
  add(plotOf("link", "ms"), "p95", "95 %", { token: "limited" }, ms(link.p95));
  for (let left = Math.max(1, skipped); left > 0; --left) {  // a frame that is late is no gap; one that is missing is
    newest = (newest + 1) % SIZE;
    const known = left === 1 || skipped < LATE / STEP;
    for (const plot of plots.values()) for (const signal of plot.signals) signal.values[newest] = known ? signal.next : NaN;
  }
  if (document.hidden || now - drawn < REDRAW) return;
  drawn = now;
  draw();
});

function draw() {
  const began = performance.now();
  if (tab() === "plots") {
    for (const plot of plots.values()) if (!plot.element.hidden) plot.show(span, STEP, newest);
  } else if (tab() === "drive") {
    mini.signals = plots.get("speed")?.signals ?? [];
    mini.show(MINI, STEP, newest);
  } else return;
  if (times.push(performance.now() - began) > TIMES) times.shift();
  document.body.dataset.redraw = [...times].sort((a, b) => a - b)[times.length >> 1].toFixed(1);
}

by("plots-span").append(...SPANS.map((seconds) => new Option(`${seconds} s`, seconds, false, seconds === span)));
by("plots-span").addEventListener("change", () => {
  span = Number(by("plots-span").value);
  for (const plot of plots.values()) plot.window = null;
  draw();
});
by("plots-pause").addEventListener("click", () => {
  paused = !paused;
  by("plots-pause").setAttribute("aria-pressed", String(paused));
  by("plots-pause").textContent = words(paused ? "Go on" : "Pause");
});
addEventListener("resize", draw);

/** The newest value of each signal of a plot, and how many of its values are known: for tests. */
export const seen = (name) => plots.get(name)?.signals.map(({ key, values, style }) =>
  ({ key, style, value: values[newest], known: values.filter((value) => !Number.isNaN(value)).length }));
export const names = () => [...plots.keys()];
