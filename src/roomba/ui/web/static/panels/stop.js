/** The emergency stop: its button in the state line, and in each dialog, behind which that cannot be pressed. */
import { put } from "../dom.js";
import { wish } from "../link.js";
import { get, mayMove, on } from "../store.js";

const buttons = document.querySelectorAll(".emergency");

/** Connect the buttons. */
export function begin() {
  for (const button of buttons) button.onclick = () => (get("state")?.held ? wish("release") : emergency());
  on("state mayChange link", show);
}

/** Hold the drive at once. */
export function emergency() { return wish("emergency_stop", {}); }

function show() {
  const isHeld = Boolean(get("state")?.held);
  for (const button of buttons) {
    put(button, isHeld ? "Release" : "Stop now");
    button.disabled = isHeld ? !mayMove() : get("mayChange") === false;
  }
}
