/** The buttons: clean, pause, dock, stop, explore, emergency stop. */
import { $, put } from "../dom.js";
import { wish } from "../link.js";
import { get, on, set } from "../store.js";

const STANDS = ["docked", "idle"];

/** Connect the buttons. */
export function begin() {
  $("clean").onclick = clean;
  $("pause").onclick = pauseOrResume;
  $("dock").onclick = () => wish("dock");
  $("stop").onclick = () => wish("stop");
  $("explore").onclick = () => wish("explore");
  $("bin").onclick = () => wish("empty_bin");
  $("emergency").onclick = () => (get("state")?.held ? wish("release") : emergency());
  on("state chosen home mayChange", show);
}

/** Hold the drive at once. */
export function emergency() { return wish("emergency_stop", {}); }

/** Pause, or go on. */
export function pauseOrResume() {
  const phase = get("state")?.vacuum.phase;
  return wish(phase === "paused" || phase === "error" ? "resume" : "pause");
}

/** What of a clean is the same for all ways to begin one. */
export function how() {
  return { passes: Number($("passes").value), fan: $("fan").value };
}

async function clean() {
  const chosen = get("chosen");
  const order = chosen.length ? { mode: "rooms", rooms: chosen, in_order: true } : { mode: $("mode").value };
  if (await wish("clean", { ...order, ...how() })) set("chosen", []);
}

function show() {
  const state = get("state"), chosen = get("chosen"), phase = state?.vacuum.phase ?? "";
  const stands = STANDS.includes(phase), isHeld = Boolean(state?.held);
  const isPaused = phase === "paused" || phase === "error";
  put($("clean"), chosen.length ? `Clean ${chosen.length} room${chosen.length > 1 ? "s" : ""}` : "Clean all");
  put($("pause"), isPaused ? "Go on" : "Pause");
  $("pause").disabled = stands || isHeld;
  $("stop").disabled = (stands && !state?.speed) || isHeld;
  $("clean").disabled = isHeld;
  $("dock").disabled = phase === "docked" || isHeld;
  $("mode").disabled = chosen.length > 0;
  $("explore").hidden = (get("home")?.furniture.length ?? 0) > 0 || (get("home")?.rooms.length ?? 0) > 0;
  $("bin").hidden = !/bin/.test(state?.vacuum.message ?? "") && phase !== "bin full";
  put($("emergency"), isHeld ? "Release" : "Stop now");
  for (const button of document.querySelectorAll(".panel button, .emergency"))
    button.title = get("mayChange") ? "" : "Open the page by the address that the robot's program printed: it holds the token.";
}
