// The WebSocket: one connection that comes back by itself, and what is known of its age.
const SILENT = 1000;  // ms without a message, after which nothing on the page is new
const handlers = {};
let socket = null, heard = -Infinity, wait = 250;

export const on = (type, handler) => (handlers[type] ??= []).push(handler);
export const silent = () => performance.now() - heard > SILENT;

export function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

let calls = 0;
const waiting = new Map();
/** Resolves with {accepted, text}. */
export function call(name, args = {}) {
  const number = ++calls;
  send({ type: "call", number, name, arguments: args });
  return new Promise((resolve) => waiting.set(number, resolve));
}

export function reconnect() { socket?.close(); }

export function connect() {
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
  const own = socket;
  own.onopen = () => { wait = 250; emit("open", {}); };
  own.onmessage = ({ data }) => {
    heard = performance.now();
    const message = JSON.parse(data);
    if (message.type === "ping") send({ type: "pong", name: message.name });
    else emit(message.type, message);
  };
  own.onclose = async (event) => {
    for (const resolve of waiting.values()) resolve({ accepted: false, text: "the connection was lost" });
    waiting.clear();
    emit("closed", { code: event.code });
    if (event.code === 4401 || (await loggedOut())) location.assign("/login");
    else setTimeout(connect, wait = Math.min(2 * wait, 2000));
  };
}

async function loggedOut() {
  try { return (await fetch("/api/model")).status === 401; } catch { return false; }
}

function emit(type, message) {
  if (type === "answer") { waiting.get(message.number)?.(message); waiting.delete(message.number); }
  for (const handler of handlers[type] ?? []) handler(message);
}
