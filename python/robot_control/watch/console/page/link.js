// The WebSocket: one connection that comes back by itself, and what is known of its age.
const SILENT = 1000;                       // ms without a message, after which nothing on the page is new
const FIRST_WAIT = 250, MAX_WAIT = 2000;   // ms between two tries to connect
const handlers = {}, waiting = new Map();
let socket = null, heard = -Infinity, wait = FIRST_WAIT, calls = 0;

export const on = (type, handler) => (handlers[type] ??= []).push(handler);
export const silent = () => performance.now() - heard > SILENT;
export const reconnect = () => socket?.close();

export function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
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
    emit("closed", {});
    if (code === 4409) emit("said", { text: "this page gave way to a newer one of yours: reload it to go on" });
    else if (code === 4401 || (await loggedOut())) location.assign("/login");
    else setTimeout(connect, wait = Math.min(2 * wait, MAX_WAIT));
  };
}

async function loggedOut() {
  try { return (await fetch("/work.js")).status === 401; } catch { return false; }
}

function emit(type, message) {
  if (type === "answer") { waiting.get(message.number)?.(message); waiting.delete(message.number); }
  for (const handler of handlers[type] ?? []) handler(message);
}
