/** The emergency stop: its button in the state line, and in each dialog, behind which that cannot be pressed. */
import { put } from "../dom.js";
import { wish } from "../link.js";
import { get, on } from "../store.js";

const buttons = document.querySelectorAll(".emergency");

/** Connect the buttons. */
export function begin() {
  for (const button of buttons) button.onclick = () => (get("state")?.held ? wish("release") : emergency());
  on("state mayChange", show);
}

/** Hold the drive at once. */
export function emergency() { return wish("emergency_stop", {}); }

function show() {
  for (const button of buttons) {
    put(button, get("state")?.held ? "Release" : "Stop now");
    button.disabled = get("mayChange") === false;
  }
}
