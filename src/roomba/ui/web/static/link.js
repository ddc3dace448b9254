/** The connection to the server: a stream of snapshots that comes back by itself, and wishes. */
import { get, isConnected, set } from "./store.js";
import { forgetGrids, takeTiles } from "./map/grids.js";
import { view } from "./map/view.js";
import { sentence } from "./words.js";

const STALE = 1500; // ms without news after which what is shown is told to be old
const DEAD = 8000; // ms without news after which a path is dead: after 5 s the server tells that its robot is silent
const PATIENCE = 10_000; // ms until an answer counts as lost
const RETRY = [300, 1000, 2000, 4000]; // ms before another attempt
const AGAIN = ["emergency_stop", "speed", "replay", "play/put"]; // the stop is never held back, and of the others the newest value counts

const timers = {};
let socket = null;
const underWay = new Set(); // what was asked for, and is not answered yet
let attempts = 0;
let began = 0; // ms of the page's clock: when the connection was begun
let heard = 0; // ms of the page's clock
let heardAt = 0; // and of the day
let homes = 0; // how often a home was told
let isHomeTold = false; // whether this connection has told of one

let token = keptToken();
takeToken();

/** Take the token of the printed address, if that is there, and keep it for this tab alone; returns whether it was. */
function takeToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  if (!given) return false;
  token = given;
  keepToken();
  history.replaceState(null, "", location.pathname);
  return true;
}

function keptToken() {
  try {
    return sessionStorage.getItem("token") ?? "";
  } catch {
    return ""; // a browser that keeps nothing
  }
}

function keepToken() {
  try {
    sessionStorage.setItem("token", token);
  } catch { /* a browser that keeps nothing: it holds until the page is loaded anew */ }
}

/** Where this page lies on its server: a run of the history lies in a folder of its own. */
export const BASE = new URL(".", location.href).pathname;

/** Connect, and stay connected. */
export function connect() {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  began = performance.now();
  socket = new WebSocket(`${scheme}://${location.host}${BASE}live`);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => {
    attempts = 0;
    isHomeTold = false;
    set("connection", get("connection") + 1);
    hello();
    haveSeen(0);
  };
  socket.onmessage = (event) => {
    heard = performance.now();
    heardAt = Date.now();
    if (event.data instanceof ArrayBuffer) takeTiles(event.data);
    else take(JSON.parse(event.data));
  };
  socket.onclose = connectAgain;
}

function connectAgain() {
  socket = null;
  set("link", "reconnecting");
  setTimeout(connect, RETRY[Math.min(attempts++, RETRY.length - 1)]);
}

/** Connect anew although nothing was closed: a path may die without a word. */
function giveUp() {
  socket.onopen = socket.onmessage = socket.onclose = null;
  socket.close();
  connectAgain();
}

function hello() { socket.send(JSON.stringify({ type: "hello", token })); }

/** Tell which look has come; only then comes the next one, and on a slow link no old ones wait. */
function haveSeen(looked) { socket.send(JSON.stringify({ type: "seen", looked })); }

/** An address that is typed into an open tab does not load the page anew. */
addEventListener("hashchange", () => { if (takeToken() && socket?.readyState === WebSocket.OPEN) hello(); });

setInterval(() => {
  const now = performance.now(), age = now - heard;
  set("age", age);
  if (get("link") === "live" && age > STALE) set("link", "stale");
  if (socket && now - Math.max(began, heard) > DEAD) giveUp();
}, 500);

function take(message) {
  switch (message.type) {
    case "state":
      set("state", message.pose ? { ...message, at: performance.now() } : get("state"));
      set("reason", message.reason ?? "");
      if (message.link === "live") set("seenAt", heardAt);
      if (message.link === "live" && !isConnected()) askLimits(); // before, the robot may not have told them
      set("link", message.link);
      haveSeen(message.looked ?? 0);
      break;
    case "home": takeHome(message); break;
    case "trail": {
      const before = message.whole ? [] : get("trail");
      set("trail", before.concat(message.points).slice(-20000));
      break;
    }
    case "welcome":
      set("mayChange", message.may_change);
      set("hasHistory", message.history);
      set("hasCamera", message.camera);
      set("hasMaps", message.maps);
      break;
    case "refused": refuse(message.reason); break;
  }
}

async function askLimits() {
  const limits = await ask("limits");
  if (limits) set("limits", limits);
}

/** Numbers of the server mean something within one connection only: the page counts what it is told itself. */
function takeHome(message) {
  if (!isHomeTold) forgetFloor(message.name);
  isHomeTold = true;
  set("home", { ...message, number: ++homes });
}

/** Forget what another connection told of the floor; where that was of another home, also what was chosen there. */
function forgetFloor(name) {
  forgetGrids();
  set("trail", []);
  if (!get("home") || get("home").name === name) return;
  for (const [what, none] of Object.entries({ chosen: [], hows: {}, drawing: null, zone: null, edge: null })) set(what, none);
  view.isFitted = false;
}

/** Show the robot's sentence for a while. */
export function refuse(reason) { show("refusal", sentence(reason), 6000); }

/** Tell what was done for a while, and offer to undo it where that is possible. */
export function note(text, undo) {
  document.getElementById("note-undo").hidden = !undo;
  document.getElementById("note-undo").onclick = () => { document.getElementById("note").hidden = true; undo(); };
  show("note", text, 10000);
}

function show(id, text, period) {
  const place = document.getElementById(id);
  (place.firstElementChild ?? place).textContent = text;
  place.hidden = false;
  clearTimeout(timers[id]);
  timers[id] = setTimeout(() => { place.hidden = true; }, period);
}

const ONLY_LOOKS = "This page may only look. Open it by the address that the robot's program printed: that holds the token.";
const SILENT = "The robot's program does not answer. The page connects again by itself.";

/** Ask the robot for something; what it refuses is shown. Returns whether it obeys. */
export async function wish(path, body, method = "POST") {
  const reason = await askFor(path, body, method);
  if (reason) refuse(reason);
  return reason === "";
}

/**
 * Ask the robot for something; returns why it is refused, empty when the robot obeys, null when the same action is
 * under way. A refusal of before is old news then.
 */
export async function askFor(path, body, method = "POST", headers = {}) {
  const isOnce = method === "POST" && !AGAIN.includes(path);
  if (isOnce && underWay.has(path)) return null;
  if (isOnce) underWay.add(path);
  document.getElementById("refusal").hidden = true;
  const reason = await send(path, body, method, headers);
  underWay.delete(path);
  return reason;
}

async function send(path, body, method, headers) {
  try {
    const answer = await fetch(`${BASE}api/v1/${path}`, {
      method,
      headers: { "Content-Type": "application/json", Authorization: `Bearer ${token}`, ...headers },
      body: JSON.stringify(body ?? {}),
      signal: AbortSignal.timeout(PATIENCE),
    });
    set("mayChange", answer.status !== 401);
    if (answer.ok) return "";
    if (answer.status === 401) return ONLY_LOOKS;
    const told = await answer.json();
    return typeof told.detail === "string" ? told.detail : told.detail.map((one) => one.msg).join("; ");
  } catch {
    return SILENT;
  }
}

/** Return what the server has at a path, or null; what is wrong is shown. */
export async function ask(path) {
  try {
    const answer = await fetch(`${BASE}api/v1/${path}`, { signal: AbortSignal.timeout(PATIENCE) }), told = await answer.json();
    if (answer.ok) return told;
    refuse(told.detail);
  } catch {
    refuse(SILENT);
  }
  return null;
}

/** Return what the camera sees at an angle, degrees, as a picture; null when it does not. */
export async function picture(angle) {
  try {
    const answer = await fetch(`${BASE}api/v1/camera`, {
      method: "POST",
      headers: { "Content-Type": "application/json", Authorization: `Bearer ${token}` },
      body: JSON.stringify({ angle }),
      signal: AbortSignal.timeout(PATIENCE),
    });
    if (answer.ok) return await answer.blob();
    refuse((await answer.json()).detail);
  } catch { /* the state line tells that the program does not answer */ }
  return null;
}

/** Send a twist, m/s and rad/s, at once. */
export function drive(linear, angular) {
  const stands = linear === 0 && angular === 0; // which is never too late
  if (socket?.readyState === WebSocket.OPEN && (stands || get("link") === "live")) socket.send(JSON.stringify({ type: "drive", linear, angular }));
}
