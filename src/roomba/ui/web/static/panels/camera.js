/** The camera: the newest picture at an angle, while it is open and seen. */
import { $ } from "../dom.js";
import { picture } from "../link.js";
import { get, on } from "../store.js";

const PERIOD = 1000; // ms from one picture to the next

let timer = null;

/** Take pictures while the camera is open. */
export function begin() {
  on("hasCamera", () => { $("camera").hidden = !get("hasCamera"); });
  $("camera").ontoggle = again;
  $("camera-angle").onchange = again;
  document.addEventListener("visibilitychange", again);
}

function again() {
  clearTimeout(timer);
  if ($("camera").open && !document.hidden) look();
}

async function look() {
  const angle = Number($("camera-angle").value), seen = await picture(angle);
  if (seen && angle === Number($("camera-angle").value)) show(seen, angle);
  clearTimeout(timer);
  if ($("camera").open && !document.hidden) timer = setTimeout(look, PERIOD);
}

function show(seen, angle) {
  const image = $("camera-picture"), before = image.src;
  image.src = URL.createObjectURL(seen);
  image.hidden = false;
  const side = angle === 0 ? "straight ahead" : `${Math.abs(angle)}° to the ${angle > 0 ? "left" : "right"}`;
  image.alt = `What the robot sees ${side}`;
  if (before) URL.revokeObjectURL(before);
}
