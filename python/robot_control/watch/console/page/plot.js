// One plot on a canvas: lines over the last seconds, gaps where nothing was received, a cursor with values, zoom by drag.
import { make, number, rows } from "/dom.js";
import { words } from "/words.js";

const LEFT = 44, BOTTOM = 18, TOP = 6, RIGHT = 6;  // px
const STEPS = [1, 2, 5, 10];
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** A round step, so that at most `count` of them fill the range. */
function stepOf(range, count) {
  const raw = range / count, power = 10 ** Math.floor(Math.log10(raw));
  return power * STEPS.find((step) => step * power >= raw);
}

/** The newest values of one signal by time, in a ring of fixed size; NaN is a gap. */
export class Signal {
  constructor(label, style, size) {
    Object.assign(this, { label, style, values: new Float32Array(size).fill(NaN) });
  }
}

export class Plot {
  /** `least`: the range of the vertical axis is never smaller, so that noise does not fill it. */
  constructor(parent, { title, unit, least, labels = true }) {
    this.least = least;
    this.unit = unit;
    this.signals = [];
    this.window = null;  // s of the past that a drag has chosen
    this.cursor = null;
    this.canvas = make("canvas", { tabIndex: 0 });
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${words(title)}, ${unit}`);
    this.labels = make("div", { className: "labels", hidden: !labels });
    this.title = title;
    this.head = make("h3", {}, make("span", { textContent: words(title) }), make("span", { textContent: unit }));
    this.element = make("div", {}, this.head, make("div", { className: "plot" }, this.canvas), this.labels);
    parent.append(this.element);
    this.listen();
  }

  listen() {
    let from = null;
    const share = (event) => {
      const box = this.canvas.getBoundingClientRect();
      return Math.max(0, Math.min(1, (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT)));
    };
    this.canvas.addEventListener("pointermove", (event) => { this.cursor = share(event); this.drag = from; this.draw(); });
    this.canvas.addEventListener("pointerleave", () => { this.cursor = null; this.draw(); });
    this.canvas.addEventListener("pointerdown", (event) => { from = share(event); });
    this.canvas.addEventListener("pointerup", (event) => {
      const [a, b] = [from, share(event)].sort((one, other) => one - other), [begin, end] = this.range();
      if (from !== null && b - a > 0.04) this.window = [begin + a * (end - begin), begin + b * (end - begin)];
      from = this.drag = null;
      this.draw();
    });
    this.canvas.addEventListener("dblclick", () => { this.window = null; this.draw(); });
    this.canvas.addEventListener("keydown", ({ key }) => {
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[key];
      if (key === "Home") this.window = null;
      else if (!step) return;
      else this.cursor = Math.max(0, Math.min(1, (this.cursor ?? 1) + step));
      this.draw();
    });
  }

  /** s before now: begin and end of what is shown. */
  range() { return this.window ?? [-this.span, 0]; }

  /** Draws the signals, of which the newest value is `newest`, and one comes each `step` s. */
  show(span, step, newest) {
    Object.assign(this, { span, step, newest });
    this.draw();
  }

  draw() {
    const { canvas } = this, ratio = devicePixelRatio, { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height || !this.span) return;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d"), [begin, end] = this.range(), w = width - LEFT - RIGHT, h = height - TOP - BOTTOM;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = `11px ${css("font")}`;
    const [low, high] = this.bounds(begin, end), x = (t) => LEFT + w * (t - begin) / (end - begin);
    const y = (value) => TOP + h * (high - value) / (high - low);
    this.grid(pen, { low, high, begin, end, x, y, w, h });
    for (const { values, style } of this.signals) {
      pen.strokeStyle = style.token ? css(style.token) : style.colour;
      pen.setLineDash(style.dash ?? []);
      pen.lineWidth = 1.7;
      pen.beginPath();
      let down = false;
      const size = values.length, from = Math.max(0, Math.floor(size - 1 + begin / this.step));
      for (let i = from; i < size && i <= size - 1 + end / this.step + 1; ++i) {
        const value = values[(this.newest + 1 + i) % size], t = (i - size + 1) * this.step;
        if (Number.isNaN(value)) { down = false; continue; }
        if (down) pen.lineTo(x(t), y(value));
        else { pen.moveTo(x(t), y(value)); pen.lineTo(x(t) + 0.5, y(value)); }
        down = true;
      }
      pen.save();
      pen.setLineDash(style.dash ?? []);
      pen.stroke();
      pen.restore();
    }
    pen.setLineDash([]);
    this.name(pen, { begin, end, x, h });
  }

  bounds(begin, end) {
    let low = Infinity, high = -Infinity;
    for (const { values } of this.signals) {
      const size = values.length, from = Math.max(0, Math.floor(size - 1 + begin / this.step));
      for (let i = from; i < size && i <= size - 1 + end / this.step; ++i) {
        const value = values[(this.newest + 1 + i) % size];
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (low > high) [low, high] = [0, 0];
    const middle = (low + high) / 2, half = Math.max(0.55 * (high - low), this.least / 2);
    return low >= 0 && middle - half < 0 ? [-0.06 * half, 1.94 * half] : [middle - half, middle + half];
  }

  grid(pen, { low, high, begin, end, x, y, w, h }) {
    pen.fillStyle = css("dim");
    pen.strokeStyle = css("line");
    pen.lineWidth = 1;
    pen.textAlign = "right";
    const step = stepOf(high - low, 4), digits = Math.max(0, -Math.floor(Math.log10(step)));
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
      pen.strokeRect(LEFT, y(value), w, 0);
      pen.fillText(number(value, digits), LEFT - 6, y(value) + 4);
    }
    pen.textAlign = "center";
    const seconds = stepOf(end - begin, Math.max(2, w / 90));
    for (let t = Math.ceil(begin / seconds) * seconds; t <= end + 1e-6; t += seconds) {
      pen.fillText(`${number(t, seconds < 1 ? 1 : 0)} s`, Math.min(x(t), LEFT + w - 10), TOP + h + 14);
    }
    if (this.drag !== null && this.drag !== undefined && this.cursor !== null) {
      pen.fillStyle = css("line");
      pen.fillRect(LEFT + w * Math.min(this.drag, this.cursor), TOP, w * Math.abs(this.cursor - this.drag), h);
    }
  }

  /** The names with their values: at the cursor, else the newest ones. */
  name(pen, { begin, end, x, h }) {
    const at = this.cursor === null ? end : begin + this.cursor * (end - begin);
    if (this.cursor !== null) {
      pen.strokeStyle = css("edge");
      pen.strokeRect(x(at), TOP, 0, h);
    }
    if (this.labels.hidden) return;
    rows(this.labels, this.signals.length, () => make("span", {}, make("i"), make("span"))).forEach((row, i) => {
      const { label, style, values } = this.signals[i], size = values.length;
      const index = Math.max(0, Math.min(size - 1, Math.round(size - 1 + at / this.step)));
      const value = values[(this.newest + 1 + index) % size];
      row.firstChild.style.borderTopColor = style.token ? `var(--${style.token})` : style.colour;
      row.firstChild.style.borderTopStyle = style.dash ? "dashed" : "solid";
      const text = `${words(label)} ${Number.isNaN(value) ? "–" : number(value)}`;
      if (row.lastChild.textContent !== text) row.lastChild.textContent = text;
    });
  }
}
