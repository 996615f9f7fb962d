// Plots of the last minute. Their memory is fixed, and they rest while nobody can see them.
import { Chart, LineController, LineElement, PointElement, LinearScale, Legend, Title } from "/lib/chart.js/chart.mjs";
import { on } from "/link.js";

Chart.register(LineController, LineElement, PointElement, LinearScale, Legend, Title);
const SPAN = 60, STEP = 0.2, POINTS = SPAN / STEP, REDRAW = 400;  // s, s, points, ms
const COLOURS = ["#3b82f6", "#d97706", "#10a35a", "#c026d3", "#64748b", "#dc2626"];
const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3]];

class Plot {
  constructor(id, title) {
    this.box = document.getElementById(id).parentElement;
    this.sets = [];
    this.chart = new Chart(document.getElementById(id), {
      type: "line", data: { datasets: this.sets },
      options: {
        animation: false, parsing: false, normalized: true, responsive: true, maintainAspectRatio: false, events: [],
        elements: { point: { radius: 0 }, line: { borderWidth: 1.5 } },
        plugins: { legend: { position: "right", labels: { boxWidth: 18, font: { size: 10 } } }, title: { display: true, text: title } },
        scales: { x: { type: "linear", min: -SPAN, max: 0, ticks: { maxTicksLimit: 7 } }, y: { ticks: { maxTicksLimit: 5 } } },
      },
    });
  }
  add(values) {
    Object.entries(values).slice(0, 8).forEach(([label, value]) => {
      let set = this.sets.find((each) => each.label === label);
      if (!set) {
        if (this.sets.length >= 8) return;
        const nth = this.sets.length;
        set = { label, data: Array.from({ length: POINTS }, (_, i) => ({ x: (i + 1 - POINTS) * STEP, y: NaN })),
          borderColor: COLOURS[nth % COLOURS.length], borderDash: DASHES[nth % DASHES.length] };
        this.sets.push(set);
      }
      set.next = value ?? NaN;
    });
    for (const set of this.sets) {
      for (let i = 1; i < POINTS; ++i) set.data[i - 1].y = set.data[i].y;
      set.data[POINTS - 1].y = set.next ?? NaN;
      set.next = NaN;
    }
  }
  draw() {
    const ink = getComputedStyle(document.body).color;
    Chart.defaults.color = this.chart.options.color = ink;
    this.chart.options.plugins.title.color = this.chart.options.plugins.legend.labels.color = ink;
    this.chart.update("none");
  }
}

const speed = new Plot("plot-speed", "speed, m/s"), torque = new Plot("plot-torque", "torque, N·m");
const error = new Plot("plot-error", "wheel speed error, rad/s"), latency = new Plot("plot-latency", "link, ms");
const all = [speed, torque, error, latency];
const times = [];  // ms of the last redraws
let last = -Infinity, drawn = -Infinity, link = {}, turn = 0;

on("desk", (desk) => { link = desk.link; });
on("fast", (frame) => {
  const now = performance.now();
  if (now - last >= 1000 * STEP * 0.9) {
    last = now;
    speed.add({ asked: frame.asked?.[0], limited: frame.limited?.[0], measured: frame.measured?.[0], true: frame.true?.[0] });
    torque.add(Object.fromEntries((frame.wheels ?? []).map((wheel) => [wheel.name, wheel.effort])));
    error.add(Object.fromEntries((frame.wheels ?? []).map((wheel) => [wheel.name, wheel.error])));
    latency.add({ "round trip": link.last * 1000, "95 %": link.p95 === null ? null : link.p95 * 1000 });
  }
  if (document.hidden || now - drawn < REDRAW / all.length) return;
  drawn = now;
  const plot = all[turn++ % all.length], began = performance.now();
  plot.draw();
  if (times.push(performance.now() - began) > 100) times.shift();
  document.body.dataset.redraw = [...times].sort((a, b) => a - b)[times.length >> 1].toFixed(1);
});
