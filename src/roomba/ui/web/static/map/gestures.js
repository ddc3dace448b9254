/** Pointer, touch and wheel on the map: pan, pinch, zoom, tap, and drawing. */
import { get, set } from "../store.js";
import { pan, toFloor, zoom } from "./view.js";

const canvas = document.getElementById("floor");
const TAP = 6; // pixels that a tap may move

const pointers = new Map();
let moved = 0;

/** Call `tapped(x, y, px, py)` for a tap on the floor, m and pixels, `drawn(draft)` for a draft. */
export function begin(tapped, drawn) {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, place(event));
    if (pointers.size === 1) moved = 0;
    const drawing = get("drawing");
    if (drawing && pointers.size === 1) {
      const at = toFloor(...place(event));
      set("drawing", { ...drawing, from: at, to: at });
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = place(event), drawing = get("drawing");
    moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
    if (drawing?.from && pointers.size === 1) set("drawing", { ...drawing, to: toFloor(...now) });
    else if (pointers.size === 2) pinch(event.pointerId, before, now);
    else pan(now[0] - before[0], now[1] - before[1]);
    pointers.set(event.pointerId, now);
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId) || pointers.size) return;
    const drawing = get("drawing");
    if (drawing?.from) {
      if (event.type === "pointerup" && moved > TAP) drawn(drawing);
      set("drawing", drawing.from && moved > TAP ? null : { kind: drawing.kind, room: drawing.room });
    } else if (event.type === "pointerup" && moved <= TAP) {
      const at = place(event);
      tapped(...toFloor(...at), ...at);
    }
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY * 0.0015), ...place(event));
  }, { passive: false });
}

function place(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function pinch(id, before, now) {
  const [other] = [...pointers].filter(([pointer]) => pointer !== id).map(([, at]) => at);
  const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
  const is = Math.hypot(now[0] - other[0], now[1] - other[1]);
  if (was > 0) zoom(is / was, (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
}
