// The WebSocket: one connection that comes back by itself, and what is known of its age.
const SILENT = 1000;                       // ms without a message, after which nothing on the page is new
const FIRST_WAIT = 250, MAX_WAIT = 2000;   // ms between two tries to connect
const PASSING = ["answer", "said", "closed"];  // what nobody has to know later
const handlers = {}, waiting = new Map(), newest = new Map();
const READ = 200;                          // ms between two changes of a number on the page
const LOOK = 200;                          // ms between two looks for silence
let socket = null, heard = -Infinity, wait = FIRST_WAIT, calls = 0, wasSilent = true;

/** A handler that comes late, as those of the pictures do, begins with the newest message. */
export function on(type, handler) {
  (handlers[type] ??= []).push(handler);
  if (newest.has(type)) handler(newest.get(type));
}
export const silent = () => performance.now() - heard > SILENT;
export const reconnect = () => socket?.close();

export function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

/** As `on`, for what people read: the newest message of a type, no more often than they can follow. */
export function onRead(type, handler) {
  let due = 0, waits = null;
  on(type, (message) => {
    const now = performance.now();
    clearTimeout(waits);
    if (now >= due) {
      due = now + READ;
      handler(message);
    } else waits = setTimeout(() => { due = performance.now() + READ; handler(message); }, due - now);
  });
}

/** Resolves with {accepted, text}. */
export function call(name, args = {}) {
  const number = ++calls;
  send({ type: "call", number, name, arguments: args });
  return new Promise((resolve) => waiting.set(number, resolve));
}

export function connect() {
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
  socket.onopen = () => { wait = FIRST_WAIT; emit("open", {}); };
  socket.onmessage = ({ data }) => {
    heard = performance.now();
    const message = JSON.parse(data);
    if (message.type === "ping") send({ type: "pong", name: message.name });
    else emit(message.type, message);
  };
  socket.onclose = async ({ code }) => {
    for (const resolve of waiting.values()) resolve({ accepted: false, text: "the connection was lost" });
    waiting.clear();
    newest.clear();
    emit("closed", {});
    if (code === 4409) emit("said", { text: "this page gave way to a newer one of yours: reload it to go on" });
    else if (code === 4401 || (await loggedOut())) location.assign("/login");
    else setTimeout(connect, wait = Math.min(2 * wait, MAX_WAIT));
  };
}

// What is shown of a robot that is no longer heard is nothing: a frame without values.
setInterval(() => {
  if (silent() && !wasSilent) emit("fast", { ages: {} });
  wasSilent = silent();
}, LOOK);

async function loggedOut() {
  try { return (await fetch("/main.js")).status === 401; } catch { return false; }
}

function emit(type, message) {
  if (type === "answer") { waiting.get(message.number)?.(message); waiting.delete(message.number); }
  if (!PASSING.includes(type)) newest.set(type, message);
  for (const handler of handlers[type] ?? []) handler(message);
}
