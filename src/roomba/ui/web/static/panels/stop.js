/** The emergency stop: its button in the state line, and in each dialog, behind which that cannot be pressed. */
import { put } from "../dom.js";
import { wish } from "../link.js";
import { get, mayMove, on } from "../store.js";

const buttons = document.querySelectorAll(".emergency");

/** Connect the buttons. */
export function begin() {
  for (const button of buttons) button.onclick = (event) => (isHeld() && event.detail < 2 ? wish("release") : emergency());
  on("state mayChange link", show);
}

/** Hold the drive at once. */
export function emergency() { return wish("emergency_stop", {}); }

/** Whether the drive is held, for all that is known now: by an old look it may have been released meanwhile. */
function isHeld() { return Boolean(get("state")?.held) && mayMove(); }

function show() {
  for (const button of buttons) {
    put(button, isHeld() ? "Release" : "Stop now");
    button.disabled = get("mayChange") === false;
  }
}
