// Plots of the last minute. Their memory is fixed, and they rest while nobody can see them.
import { Chart, LineController, LineElement, PointElement, LinearScale, Legend, Title } from "/lib/chart.js/chart.mjs";
import { on } from "/link.js";
import { words } from "/words.js";

Chart.register(LineController, LineElement, PointElement, LinearScale, Legend, Title);
const SPAN = 60, STEP = 0.2, POINTS = SPAN / STEP, REDRAW = 400, MAX_LINES = 8;  // s, s, points, ms
const COLOURS = ["#3b82f6", "#d97706", "#10a35a", "#c026d3", "#64748b", "#dc2626"];
const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3]];

class Plot {
  constructor(id, title) {
    this.sets = [];
    this.title = title;
    this.chart = new Chart(document.getElementById(id), {
      type: "line", data: { datasets: this.sets },
      options: {
        animation: false, parsing: false, normalized: true, responsive: true, maintainAspectRatio: false, events: [],
        elements: { point: { radius: 0 }, line: { borderWidth: 1.5 } },
        plugins: {
          legend: { position: "bottom", labels: { boxWidth: 18, font: { size: 10 } } },
          title: { display: true },
        },
        scales: {
          x: { type: "linear", min: -SPAN, max: 0, ticks: { maxTicksLimit: 7 } },
          y: { ticks: { maxTicksLimit: 5 } },
        },
      },
    });
  }
  add(values) {
    for (const label of Object.keys(values).slice(0, MAX_LINES)) {
      if (this.sets.length >= MAX_LINES || this.sets.some((set) => set.key === label)) continue;
      const data = Array.from({ length: POINTS }, (_, i) => ({ x: (i + 1 - POINTS) * STEP, y: NaN }));
      const nth = this.sets.length, borderDash = DASHES[nth % DASHES.length];
      this.sets.push({ key: label, data, borderColor: COLOURS[nth % COLOURS.length], borderDash });
    }
    for (const { key, data } of this.sets) {
      for (let i = 1; i < POINTS; ++i) data[i - 1].y = data[i].y;
      data[POINTS - 1].y = values[key] ?? NaN;
    }
  }
  draw() {
    const { options } = this.chart, { title, legend } = options.plugins, { color } = getComputedStyle(document.body);
    Chart.defaults.color = options.color = title.color = legend.labels.color = color;
    title.text = words(this.title);
    for (const set of this.sets) set.label = words(set.key);
    this.chart.update("none");
  }
}

const speed = new Plot("plot-speed", "speed, m/s"), torque = new Plot("plot-torque", "torque, N·m");
const error = new Plot("plot-error", "error of wheels, rad/s, or of joints, rad"), latency = new Plot("plot-latency", "link, ms");
const all = [speed, torque, error, latency], times = [];  // ms of the last redraws
let last = -Infinity, drawn = -Infinity, link = {}, turn = 0;

on("authority", (authority) => { link = authority.link; });
on("fast", (frame) => {
  const now = performance.now(), ms = (value) => value === null ? null : 1000 * value;
  const driven = (of) => Object.fromEntries((frame.driven ?? []).map((joint) => [joint.name, joint[of]]));
  if (now - last >= 1000 * STEP * 0.9) {
    last = now;
    speed.add(Object.fromEntries(["asked", "limited", "measured", "true"].map((name) => [name, frame[name]?.[0]])));
    torque.add(driven("effort"));
    error.add(driven("error"));
    latency.add({ "round trip": ms(link.last), "95 %": ms(link.p95) });
  }
  if (document.hidden || now - drawn < REDRAW / all.length) return;
  drawn = now;
  const plot = all[turn++ % all.length], began = performance.now();
  plot.draw();
  if (times.push(performance.now() - began) > 100) times.shift();
  document.body.dataset.redraw = [...times].sort((a, b) => a - b)[times.length >> 1].toFixed(1);
});
