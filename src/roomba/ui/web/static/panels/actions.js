/** The buttons: clean, pause, dock, stop, explore; and how is cleaned. */
import { $, offer, put } from "../dom.js";
import { refuse, wish } from "../link.js";
import { get, isConnected, mayMove, on, set } from "../store.js";
import { CARPETS, EDGES, MODES } from "../words.js";
import { askYes } from "./ask.js";
import * as queue from "./queue.js";

const STANDS = ["docked", "idle"];
const FULL = ["bin full", "not emptied"]; // hindrances after which a person empties its bin
const STEP = 0.1; // m/s between two top speeds that can be chosen
const USUAL = { passes: 1, fan: "standard", carpets: "boost", edges: "any" };

let recalled = ""; // the key of what was recalled

/** Connect the buttons. */
export function begin() {
  $("clean").onclick = () => (adds() ? queue.add() : clean());
  $("pause").onclick = pauseOrResume;
  $("dock").onclick = () => wish("dock");
  $("stop").onclick = () => wish("stop");
  $("explore").onclick = () => wish("explore");
  $("bin").onclick = () => wish("empty_bin");
  $("locate").onclick = () => wish("locate");
  $("top-speed").onchange = () => wish("speed", { speed: Number($("top-speed").value) });
  document.addEventListener("click", onceOnly, true);
  for (const name of Object.keys(USUAL)) $(name).onchange = keep;
  on("limits", showLimits);
  on("home", recall);
  on("state chosen home mayChange link limits", show);
}

/** A double click means one press, but of what zooms; and no stop is held back. */
function onceOnly(event) {
  if (event.detail < 2 || !event.target.closest("button") || event.target.closest(".emergency, .tools")) return;
  event.preventDefault();
  event.stopImmediatePropagation();
}

/** Pause, or go on, when the button offers it. */
export async function pauseOrResume() {
  if ($("pause").disabled) return;
  await wish(isPaused() ? "resume" : "pause");
}

function isPaused() { return ["paused", "error"].includes(get("state")?.vacuum.phase); }

/** Whether the rooms that are chosen are added to a clean of rooms under way. */
function adds() { return get("chosen").length > 0 && queue.rooms().length > 0; }

/** Begin a clean; what is under way is given up for it only after a yes. Returns whether the robot obeys. */
export async function beginClean(order) { return await mayEnd() && wish("clean", { ...order, ...how() }); }

/** Return whether the robot may begin something: what is shown is not old, and what is under way, if anything is, is given up for it. */
export async function mayEnd() {
  const vacuum = get("state")?.vacuum, isBusy = vacuum?.wanted > 0 || vacuum?.phase === "exploring";
  const isWished = !isBusy || await askYes("It has not finished what it does now. End that, and begin this?");
  if (isWished && !mayMove()) refuse("what is shown is old; begin it when the robot is seen again");
  return isWished && mayMove();
}

/** What of a clean is the same for all ways to begin one; before the limits came, what is usual. */
export function how() {
  return {
    passes: Number($("passes").value) || USUAL.passes, fan: $("fan").value || USUAL.fan,
    carpets: $("carpets").value || USUAL.carpets, edges: $("edges").value || USUAL.edges,
  };
}

async function clean() {
  const chosen = get("chosen"), hows = get("hows"), usual = how();
  const order = chosen.length ? { mode: "rooms", rooms: chosen, in_order: true } : { mode: $("mode").value || "whole" };
  if (chosen.some((name) => hows[name]))
    order.each = chosen.map((name) => ({ passes: usual.passes, fan: usual.fan, ...hows[name] }));
  if (await beginClean(order)) set("chosen", []);
}

function showLimits() {
  const limits = get("limits");
  if (!limits) return;
  document.querySelector(".how").hidden = false;
  offer($("passes"), numbers(limits.most_passes), $("passes").value || USUAL.passes);
  offer($("fan"), limits.fans.map((fan) => [fan, fan]), $("fan").value || USUAL.fan);
  offer($("carpets"), limits.carpets.map((way) => [way, CARPETS[way] ?? way]), $("carpets").value || USUAL.carpets);
  offer($("edges"), limits.edges.map((order) => [order, EDGES[order] ?? order]), $("edges").value || USUAL.edges);
  offer($("mode"), limits.modes.filter((mode) => mode in MODES).map((mode) => [mode, MODES[mode]]));
  const speeds = [];
  for (let speed = limits.min_speed; speed < limits.max_speed + 0.01; speed += STEP) speeds.push([speed.toFixed(1), speed.toFixed(1)]);
  offer($("top-speed"), speeds, limits.max_speed.toFixed(1));
  recalled = "";
  recall();
}

/** Keep in this browser how is cleaned in this home. */
function keep() {
  try {
    localStorage.setItem(storageKey(), JSON.stringify(how()));
  } catch { /* a browser that keeps nothing: it is chosen anew each time */ }
}

/** Choose once what was kept for this home, as far as it can still be chosen, and else what is usual. */
function recall() {
  if (!get("home") || !get("limits") || recalled === storageKey()) return;
  recalled = storageKey();
  const values = { ...USUAL, ...kept() };
  for (const name of Object.keys(USUAL))
    if ([...$(name).options].some((option) => option.value === String(values[name]))) $(name).value = String(values[name]);
}

function kept() {
  try {
    return JSON.parse(localStorage.getItem(storageKey())) ?? {};
  } catch {
    return {}; // nothing that can be read is kept
  }
}

function storageKey() { return `how is cleaned in ${get("home")?.name}`; }

/** Return the numbers from 1 to the most, as a select offers them. */
export function numbers(most) { return Array.from({ length: most }, (_, index) => [index + 1, String(index + 1)]); }

function show() {
  const state = get("state"), chosen = get("chosen"), phase = state?.vacuum.phase ?? "";
  const stands = STANDS.includes(phase), isHeld = Boolean(state?.held), home = get("home");
  const isHeard = isConnected(), hasNoMap = Boolean(get("limits")?.explores && home) && !home.furniture.length && !home.rooms.length;
  const isFull = phase === "bin full" || FULL.includes(state?.vacuum.hindrance);
  put($("clean"), adds() ? "Add what is chosen" : chosen.length ? `Clean ${chosen.length} room${chosen.length > 1 ? "s" : ""}` : "Clean all");
  put($("pause"), isPaused() ? "Go on" : "Pause");
  const isUnderWay = !stands && !isHeld && phase !== "" && !isFull;
  $("pause").classList.toggle("first", isUnderWay);
  $("clean").classList.toggle("first", !isUnderWay && !isFull && !(hasNoMap && stands));
  for (const mover of document.querySelectorAll(".moves")) mover.disabled = !mayMove();
  $("pause").disabled = stands || isHeld || !isHeard || (isPaused() && !mayMove());
  $("stop").disabled = (stands && !state?.speed && !isHeld) || !isHeard;
  $("clean").disabled ||= isHeld || adds() && queue.more().length === 0;
  $("dock").disabled ||= isHeld || phase === "docked";
  $("mode").disabled = chosen.length > 0;
  if (state?.top_speed && document.activeElement !== $("top-speed")) $("top-speed").value = state.top_speed.toFixed(1);
  $("no-map").hidden = !hasNoMap || !stands || isHeld || !isHeard || Boolean(state?.replay);
  $("bin").hidden = !isFull;
  $("only-looks").hidden = get("mayChange") !== false || Boolean(state?.replay);
  for (const controls of document.querySelectorAll(".asks, #note-undo")) controls.disabled = get("mayChange") === false || !isHeard;
}
