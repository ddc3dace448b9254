/** What can be done at a place that was tapped, and only that. */
import { wish } from "../link.js";
import { get } from "../store.js";
import { how } from "./actions.js";
import { isShown } from "./replay.js";
import { toggle } from "./rooms.js";

const MARGIN = 8, BESIDE = 12; // pixels
const place = document.getElementById("offer");

/** Offer what can be done at (x, y), m, beside the pixels that were tapped. */
export function tapped(x, y, px, py) {
  const room = get("home")?.rooms.find((one) => isInside(one.rings, x, y));
  const offers = [];
  if (isShown()) return;
  if (room) offers.push([get("chosen").includes(room.name) ? `Leave out ${room.name}` : `Choose ${room.name}`, () => toggle(room.name)]);
  offers.push(["Go here", () => wish("go", { x, y })]);
  offers.push(["Clean here", () => wish("clean", { mode: "spot", spot: [x, y], ...how() })]);
  offers.push(["Spill dirt", () => wish("play/spill", { x, y })]);
  offers.push(["Put a chair", () => wish("play/chair", { x, y })]);
  place.replaceChildren(...offers.map(([text, act]) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.onclick = () => { close(); act(); };
    return button;
  }));
  place.hidden = false;
  const { clientWidth: width, clientHeight: height } = place.parentElement, { offsetWidth, offsetHeight } = place;
  place.style.left = `${between(px - offsetWidth / 2, MARGIN, width - offsetWidth - MARGIN)}px`;
  place.style.top = `${between(py + BESIDE, MARGIN, height - offsetHeight - MARGIN)}px`;
  place.firstElementChild.focus({ preventScroll: true });
}

function between(value, least, most) { return Math.max(least, Math.min(value, most)); }

/** Take the offer away. */
export function close() { place.hidden = true; }

/** Whether a point lies within rings, by the even-odd rule. */
function isInside(rings, x, y) {
  let inside = false;
  for (const ring of rings)
    for (let one = 0, other = ring.length - 1; one < ring.length; other = one++) {
      const [ax, ay] = ring[one], [bx, by] = ring[other];
      if ((ay > y) !== (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)) inside = !inside;
    }
  return inside;
}
