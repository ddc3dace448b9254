/** Driving by hand: a stream of twists while a button or key is held, and none when the page is hidden. */
import { $, put } from "../dom.js";
import { drive } from "../link.js";
import { get, on } from "../store.js";

const PERIOD = 100; // ms

const held = new Map();
let timer = null;

/** Connect the pad. */
export function begin() {
  for (const button of document.querySelectorAll("[data-drive]")) {
    const [ahead, aside] = button.dataset.drive.split(",").map(Number);
    button.onpointerdown = (event) => { button.setPointerCapture(event.pointerId); hold(button, ahead, aside); };
    button.onpointerup = button.onpointercancel = button.onlostpointercapture = () => release(button);
    button.onkeydown = (event) => { if ([" ", "Enter"].includes(event.key)) { event.preventDefault(); event.stopPropagation(); hold(button, ahead, aside); } };
    button.onkeyup = button.onblur = () => release(button);
  }
  document.addEventListener("visibilitychange", () => { if (document.hidden) releaseAll(); });
  addEventListener("blur", releaseAll);
  addEventListener("pagehide", releaseAll);
  on("limits", showWhatItCan);
  on("link", () => { if (get("link") !== "live") releaseAll(); }); // that it is let go could be missed
}

/** Whether the arrows drive now. */
export function isOpen() { return document.querySelector("details.drive").open && !$("drive-pad").hidden; }

function showWhatItCan() {
  const drives = get("limits")?.drives !== false;
  for (const id of ["drive-pad", "drive-hint"]) $(id).hidden = !drives;
  put(document.querySelector("details.drive summary"), drives ? "Drive by hand" : "Find it");
}

/** Hold a direction, by what holds it: ahead and aside are -1, 0 or 1. */
export function hold(by, ahead, aside) {
  held.set(by, [ahead, aside]);
  if (timer === null) timer = setInterval(send, PERIOD);
  send();
}

/** Let go. */
export function release(by) {
  if (held.delete(by) && held.size === 0) releaseAll();
}

function releaseAll() {
  if (timer === null) return;
  clearInterval(timer);
  timer = null;
  held.clear();
  drive(0, 0);
}

function send() {
  let ahead = 0, aside = 0;
  for (const [one, other] of held.values()) { ahead += one; aside += other; }
  const limits = get("limits");
  if (limits) drive(Math.sign(ahead) * limits.hand_speed, Math.sign(aside) * limits.hand_turning);
}
