/** The keyboard. */
import { $ } from "../dom.js";
import { pan, toFloor, view, zoom } from "../map/view.js";
import { get, mayAsk } from "../store.js";
import { stands } from "../words.js";
import { pauseOrResume } from "./actions.js";
import * as card from "./card.js";
import { hold, isOpen, release } from "./drive.js";
import { offerAt } from "./offer.js";
import { closeNewest, showDialog } from "./opened.js";
import * as replay from "./replay.js";
import { toggleNumber } from "./rooms.js";
import { emergency } from "./stop.js";
import * as zones from "./zones.js";

const ARROWS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };
const STEP = 60; // pixels

/** Listen to keys. */
export function begin() {
  $("help").onclick = () => showDialog($("keys"));
  document.addEventListener("keydown", down);
  document.addEventListener("keyup", (event) => { if (event.key in ARROWS) release(event.key); });
}

function down(event) {
  if (event.key === "Escape") {
    if (document.querySelector("dialog[open]")) return; // it closes that
    const couldBeMoving = get("link") !== "live" || !stands(get("state"));
    if (couldBeMoving && !replay.isShown()) { // what moves is stopped before all else
      while (closeNewest("sheet", "history"));
      emergency();
    } else if (!closeNewest("sheet") && !replay.isShown()) emergency();
    return;
  }
  if (!$("history").hidden) return;
  const writes = event.target.matches?.("input, select, textarea"), onButton = event.target.matches?.("button, summary, a");
  if (writes || event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
  if (event.repeat && ["Enter", " "].includes(event.key)) event.preventDefault(); // a key that is held asks once
  else if (!onButton && mayAsk() && zones.key(event)) event.preventDefault();
  else if (event.key in ARROWS && !event.target.closest?.(".parts")?.matches(":focus")) {
    event.preventDefault();
    const [ahead, aside] = ARROWS[event.key];
    if (isOpen()) hold(event.key, ahead, aside); else pan(aside * STEP, ahead * STEP);
  } else if (event.key === " " && !onButton) {
    event.preventDefault();
    if (replay.isShown()) replay.playOrPause(); else pauseOrResume();
  } else if (event.key === "Enter" && event.target === $("floor") && mayAsk()) {
    event.preventDefault();
    offerMiddle();
  }
  else if (event.key === "+" || event.key === "=") zoom(1.4);
  else if (event.key === "-") zoom(1 / 1.4);
  else if (event.key === "?") showDialog($("keys"));
  else if (/^[1-9]$/.test(event.key) && mayAsk()) toggleNumber(Number(event.key));
}

/** Offer what can be done in the middle of the map. */
function offerMiddle() {
  offerAt(...toFloor(view.width / 2, view.height / 2));
  if (card.isOpen()) card.focus();
}
