/** Pointer, touch and wheel on the map: pan, pinch, zoom, tap, long press, and dragging things. */
import { chosenZone, get, mayAsk, moveZone, set } from "../store.js";
import { pan, toFloor, toScreen, zoom } from "./view.js";
import { cornerAt, isHit, shifted, withCorner } from "./zones.js";

const canvas = document.getElementById("floor");
const TAP = 6; // pixels that a tap may move
const LONG = 500; // ms that a long press takes

const pointers = new Map();
let moved = 0;
let pressed = null; // what a long press waits for
let drag = null; // what is dragged: "pan", "draft", or a function of the place, m

/**
 * Call `tapped(x, y, px, py)` for a tap on the floor, m and pixels, `drawn(draft)` for a draft, `zoneMoved()`
 * for a zone that was dragged; `mayCarry()` tells whether the robot may be dragged, `carried(begin or end, x, y)` follows it.
 */
export function begin({ tapped, drawn, zoneMoved, mayCarry, carried }) {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
    if (pointers.size > 1) { stopWaiting(); if (drag !== "draft") drag = "pan"; letGo(); return; }
    moved = 0;
    drag = grasp(place(event), { mayCarry, carried });
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
    pointers.set(event.pointerId, now);
    if (moved > TAP) stopWaiting();
    if (pointers.size === 2) pinch(event.pointerId, before, now);
    else if (drag === "draft") set("drawing", { ...get("drawing"), to: toFloor(...now) });
    else if (typeof drag === "function") drag(...toFloor(...now));
    else pan(now[0] - before[0], now[1] - before[1]);
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId) || pointers.size) return;
    stopWaiting();
    const isDone = event.type === "pointerup", at = place(event);
    if (drag === "draft") endDraft(isDone, drawn);
    else if (get("carried")) { carried(isDone && moved > TAP ? "end" : "back", ...get("carried")); set("carried", null); }
    else if (typeof drag === "function" && (moved > TAP || !isDone)) dragged(isDone, at, zoneMoved);
    else if (isDone && moved <= TAP) tapped(...toFloor(...at), ...at);
    drag = null;
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.0015), ...place(event));
  }, { passive: false });
}

/** Return what is dragged from now on. */
function grasp([px, py], { mayCarry, carried }) {
  if (!mayAsk()) return "pan";
  const [x, y] = toFloor(px, py), drawing = get("drawing"), zone = chosenZone(), state = get("state");
  if (drawing) {
    set("drawing", { ...drawing, from: [x, y], to: [x, y] });
    return "draft";
  }
  if (zone) {
    const corner = cornerAt(zone, px, py);
    if (corner >= 0) return (toX, toY) => moveZone(withCorner(zone, corner, toX, toY).points);
    if (isHit(zone, x, y, px, py)) return (toX, toY) => moveZone(shifted(zone, toX - x, toY - y).points);
  }
  if (mayCarry() && state && isOnRobot(state, px, py)) {
    carried("begin", x, y);
    set("carried", [x, y]);
    return (toX, toY) => set("carried", [toX, toY]);
  }
  if (get("limits")?.most_zones === 0) return "pan";
  pressed = setTimeout(() => {
    set("drawing", { kind: "any", from: [x, y], to: [x, y] });
    drag = "draft";
    navigator.vibrate?.(20);
  }, LONG);
  return "pan";
}

function isOnRobot(state, px, py) {
  const [x, y] = (get("layers").truth && state.truth?.pose) || state.pose, [atX, atY] = toScreen(x, y), [rim] = toScreen(x + get("home").radius, y);
  return Math.hypot(px - atX, py - atY) < Math.max(16, rim - atX);
}

function endDraft(isDone, drawn) {
  const drawing = get("drawing");
  if (!drawing) return;
  if (isDone && moved > TAP) drawn(drawing);
  else set("drawing", drawing.kind === "any" || !isDone ? null : { kind: drawing.kind, room: drawing.room });
}

/** Ask for the place to which the user dragged a zone; a place that the robot reported during the drag does not count. */
function dragged(isDone, at, zoneMoved) {
  if (!isDone) { letGo(); return; }
  drag(...toFloor(...at));
  zoneMoved();
}

/** Leave the zone that was dragged where the robot has it. */
function letGo() { moveZone(null); }

function stopWaiting() {
  clearTimeout(pressed);
  pressed = null;
}

function place(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function pinch(id, before, now) {
  const [other] = [...pointers].filter(([pointer]) => pointer !== id).map(([, at]) => at);
  const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
  const is = Math.hypot(now[0] - other[0], now[1] - other[1]);
  pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  if (was > 0) zoom(is / was, (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
}
