// A recording: its time line with the causes of stops as marks, play, pause and speed.
import { by, number, put, rows, show } from "/dom.js";
import { on, send } from "/link.js";
import { words } from "/words.js";

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
let length = 0, playing = false, held = false;

const rate = () => Number(by("rate").value);
const play = (at, speed) => send({ type: "play", at: Math.max(0, at), speed });

on("slow", ({ replay }) => {
  if (!replay) return;
  document.body.dataset.replay = "true";
  ({ length } = replay);
  playing = replay.speed > 0 && replay.at < length;
  put("play", playing ? "Pause" : "Play");
  put("loading", replay.loading);
  by("place").max = length;
  if (!held) by("place").value = replay.at;
  show(by("place-text"), `${number(held ? Number(by("place").value) : replay.at, 1)} s / ${number(length, 1)} s`);
  rows(by("marks"), replay.marks.length, () => {
    const mark = document.createElement("button");
    mark.addEventListener("click", () => play(mark.dataset.at - 2, rate()));
    return mark;
  }).forEach((mark, i) => {
    const { at, sentence } = replay.marks[i];
    mark.style.left = `${100 * at / (length || 1)}%`;
    mark.dataset.at = at;
    mark.title = `${number(at, 1)} s: ${words(sentence)}`;
    mark.setAttribute("aria-label", mark.title);
  });
});

by("rate").append(...RATES.map((each) => new Option(`${each} ×`, each, false, each === 1)));
by("rate").addEventListener("change", () => { if (playing) play(Number(by("place").value), rate()); });
by("play").addEventListener("click", () => {
  const at = Number(by("place").value);
  play(at >= length - 0.05 ? 0 : at, playing ? 0 : rate());
});
by("place").addEventListener("input", () => {
  held = true;
  play(Number(by("place").value), 0);
});
by("place").addEventListener("change", () => { held = false; });
