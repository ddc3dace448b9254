/** The keyboard. */
import { pan, zoom } from "../map/view.js";
import { emergency, pauseOrResume } from "./actions.js";
import { hold, isOpen, release } from "./drive.js";
import { close } from "./offer.js";
import * as replay from "./replay.js";
import { toggleNumber } from "./rooms.js";

const ARROWS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };
const STEP = 60; // pixels

/** Listen to keys. */
export function begin() {
  document.getElementById("help").onclick = () => document.getElementById("keys").showModal();
  document.addEventListener("keydown", down);
  document.addEventListener("keyup", (event) => { if (event.key in ARROWS) release(event.key); });
}

function down(event) {
  if (event.key === "Escape") { close(); if (!replay.isShown()) emergency(); return; }
  const writes = event.target.matches?.("input, select, textarea");
  if (writes || event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
  if (event.key in ARROWS) {
    event.preventDefault();
    const [ahead, aside] = ARROWS[event.key];
    if (isOpen()) hold(event.key, ahead, aside); else pan(aside * STEP, ahead * STEP);
  } else if (event.key === " " && !event.target.matches?.("button, summary")) {
    event.preventDefault();
    if (replay.isShown()) replay.playOrPause(); else pauseOrResume();
  } else if (event.key === "+" || event.key === "=") zoom(1.4);
  else if (event.key === "-") zoom(1 / 1.4);
  else if (event.key === "?") document.getElementById("keys").showModal();
  else if (/^[1-9]$/.test(event.key)) toggleNumber(Number(event.key));
}
