// The page's texts in the language of the browser, or of ?lang=; a text without a row stays English.
const MAX_LENGTH = 500, CACHED = 1000;  // characters of a text, texts
const language = (new URLSearchParams(location.search).get("lang") ?? navigator.language).slice(0, 2);
const whole = new Map(), patterns = [], found = new Map();

/** The text in the page's language. */
export function words(text) {
  if (whole.has(text)) return whole.get(text);
  if (!patterns.length || text.length > MAX_LENGTH || !/[a-z]{3}/i.test(text)) return text;
  if (!found.has(text)) {
    if (found.size >= CACHED) found.clear();
    found.set(text, translated(text));
  }
  return found.get(text);
}

const closed = (part) => !/[()]/.test(part.replace(/\([^()]*\)/g, ""));

// As words.py does: a part in braces is translated by itself, and the first pattern that fits counts.
function translated(text) {
  for (const [pattern, other] of patterns) {
    const parts = pattern.exec(text)?.groups;
    if (parts && Object.values(parts).every(closed)) return other.replace(/\{(\w+)\}/g, (_, name) => words(parts[name]));
  }
  return text;
}

function pattern(english) {
  const plain = english.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  return new RegExp(`^${plain.replace(/\{(\w+)\}/g, "(?<$1>.+?)")}$`);
}

function translatePage() {
  document.documentElement.lang = language;
  const texts = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { data } = texts.currentNode, other = whole.get(data.replace(/\s+/g, " ").trim());
    if (other) texts.currentNode.data = data.replace(/\S[^]*\S|\S/, () => other);
  }
  for (const element of document.querySelectorAll("[aria-label]")) {
    element.setAttribute("aria-label", words(element.getAttribute("aria-label")));
  }
}

// Until the rows are there, and without them, the page works in English: no other script waits for this one.
async function learn() {
  const answer = await fetch(`/words/${language}`).catch(() => null);
  for (const [english, other] of answer?.ok ? await answer.json() : []) {
    if (english.includes("{")) patterns.push([pattern(english), other]);
    else whole.set(english, other);
  }
  if (patterns.length) translatePage();
}
if (language !== "en") learn();
