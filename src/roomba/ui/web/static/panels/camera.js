/** The camera: live at an angle while it is open and seen, and the latest five pictures. */
import { $, offer } from "../dom.js";
import { picture } from "../link.js";
import { get, on } from "../store.js";

const PERIOD = 200, AFTER_NONE = 1000; // ms from one picture to the next, and to another try
const KEPT = 5, KEPT_EVERY = 2000; // pictures, and ms from one to the next

let timer = null, keptAt = -Infinity, isAsking = false;

/** Take pictures while the camera is open. */
export function begin() {
  on("hasCamera mayChange", () => { $("camera").hidden = !get("hasCamera") || get("mayChange") === false; });
  on("limits", () => offer($("camera-angle"), (get("limits")?.camera_angles ?? []).map((angle) => [angle, side(angle)]), $("camera-angle").value || 0));
  $("camera").ontoggle = again;
  $("camera-angle").onchange = again;
  document.addEventListener("visibilitychange", again);
  let link = "";
  on("link", () => { if (get("link") !== link) { link = get("link"); again(); } });
}

function isSeen() { return $("camera").open && !$("camera").hidden && !document.hidden && get("link") === "live"; }

function again() {
  clearTimeout(timer);
  if (isSeen() && !isAsking) look();
}

async function look() {
  const began = performance.now(), angle = Number($("camera-angle").value);
  isAsking = true;
  const seen = await picture(angle);
  isAsking = false;
  if (seen && angle === Number($("camera-angle").value)) show(seen, angle);
  clearTimeout(timer);
  if (isSeen()) timer = setTimeout(look, seen ? Math.max(20, PERIOD - (performance.now() - began)) : AFTER_NONE);
}

function side(angle) { return angle === 0 ? "ahead" : `${Math.abs(angle)}° ${angle > 0 ? "left" : "right"}`; }

function show(seen, angle) {
  const image = $("camera-picture"), before = image.src;
  image.src = URL.createObjectURL(seen);
  image.hidden = false;
  image.alt = `What the robot sees, ${angle === 0 ? "straight ahead" : `${Math.abs(angle)}° to the ${angle > 0 ? "left" : "right"}`}`;
  if (before) URL.revokeObjectURL(before);
  if (performance.now() - keptAt > KEPT_EVERY) keep(seen, angle);
}

function keep(seen, angle) {
  keptAt = performance.now();
  const time = new Date().toLocaleTimeString(), link = document.createElement("a"), small = document.createElement("img");
  small.src = link.href = URL.createObjectURL(seen);
  small.alt = `${side(angle)} at ${time}`;
  link.download = `picture ${time.replaceAll(":", ".")}.jpg`;
  link.title = `Save the picture of ${time}`;
  link.append(small);
  $("camera-latest").prepend(link);
  for (const old of [...$("camera-latest").children].slice(KEPT)) {
    URL.revokeObjectURL(old.href);
    old.remove();
  }
}
