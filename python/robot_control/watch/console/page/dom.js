// Values → elements. Text of the robot, of users and of files enters the page by textContent alone.
import { words } from "/words.js";

export const by = (id) => document.getElementById(id);
export const show = (element, text) => { if (element.textContent !== text) element.textContent = text; };
export const put = (id, text) => show(by(id), words(text));
export const value = (id) => Number(by(id).value);

export function number(value, digits = 2) {
  const text = typeof value === "number" ? value.toFixed(digits) : "–";
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

/** One child for each text; they are made by `make` and kept. */
export function rows(parent, count, make) {
  while (parent.children.length > count) parent.lastChild.remove();
  while (parent.children.length < count) parent.append(make(parent.children.length));
  return [...parent.children];
}

export function list(id, texts) {
  rows(by(id), texts.length, () => document.createElement("li")).forEach((row, i) => show(row, words(texts[i])));
}

/** The options of a choice; what is chosen stays. */
export function choices(id, texts) {
  if (texts.join() === Array.from(by(id).options, (option) => option.value).join()) return;
  by(id).replaceChildren(...texts.map((text) => new Option(words(text), text)));
}

export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
