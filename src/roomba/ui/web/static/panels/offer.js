/** What can be done at a place that was tapped, and only that. */
import { $, button } from "../dom.js";
import { wish } from "../link.js";
import { toScreen } from "../map/view.js";
import { isInside, zoneAt } from "../map/zones.js";
import { get, offers, set } from "../store.js";
import { title } from "../words.js";
import { how } from "./actions.js";
import { isShown } from "./replay.js";
import { toggle } from "./rooms.js";
import { offerZone } from "./zones.js";

const MARGIN = 8, BESIDE = 20; // pixels
const NEAR = 0.4; // m from a door's middle that still mean it

/** Choose the room at (x, y), m, or the zone, and offer what else can be done at these pixels. */
export function tapped(x, y, px, py) {
  const room = get("home")?.rooms.find((one) => isInside(one.rings, x, y));
  if (isShown()) return;
  const zone = zoneAt(x, y, px, py);
  set("zone", null);
  if (zone) { offerZone(zone); return; }
  const before = get("chosen");
  if (room) toggle(room.name);
  offerPlace(x, y, room, before);
}

/** Offer what can be done at a place; rooms are chosen as `before` when it was the place that was meant. */
export function offerPlace(x, y, room, before = get("chosen")) {
  const order = room ? get("chosen").indexOf(room.name) : -1;
  const name = !room ? "Here" : order >= 0 ? `${title(room.name)} is number ${order + 1}` : `${title(room.name)} is left out`;
  open(name, [
    ["Go here", () => wish("go", { x, y })],
    ["Clean here", () => wish("clean", { mode: "spot", spot: [x, y], ...how() })],
    ...playful(x, y),
  ].map(([words, act]) => [words, () => { set("chosen", before); act(); }]), [x, y]);
}

/** Return what can be played at a place of a simulated home. */
function playful(x, y) {
  if (!$("play").open) return [];
  const state = get("state"), acts = [];
  const door = state?.truth?.doors.find(({ opening: [left, low, right, high] }) => Math.hypot(x - (left + right) / 2, y - (low + high) / 2) < NEAR);
  if (offers("spill")) acts.push(["Spill dirt", () => wish("play/spill", { x, y })]);
  if (offers("chair")) acts.push(["Put a chair", () => wish("play/chair", { x, y })]);
  if (offers("door") && door) acts.push([`${door.is_shut ? "Open" : "Shut"} the door`, () => wish("play/door", { name: door.name, is_shut: !door.is_shut })]);
  if (offers("lift")) acts.push(["Put the robot here", () => wish("play/put", { x, y, theta: state?.pose[2] ?? 0 })]);
  return acts;
}

let dismiss = null; // what is to be done when the card is closed without a choice

/** Let the card close when something else is touched. */
export function begin() {
  addEventListener("resize", close);
  document.addEventListener("pointerdown", (event) => { if (!event.target.closest("#offer")) close(); }, true);
}

/** Open a card with a title and [words, act] for each button, beside a place, m; `otherwise` is done without a choice. */
export function open(words, acts, at, otherwise = null) {
  const place = $("offer");
  close();
  dismiss = otherwise;
  $("offer-title").textContent = words;
  $("offer-acts").replaceChildren(...acts.map(([text, act]) => button(text, () => { dismiss = null; close(); act(); })));
  place.hidden = false;
  const { clientWidth: width, clientHeight: height } = place.parentElement, { offsetWidth, offsetHeight } = place, [px, py] = toScreen(...at);
  const above = py - BESIDE - offsetHeight, below = py + BESIDE;
  place.style.left = `${between(px - offsetWidth / 2, MARGIN, width - offsetWidth - MARGIN)}px`;
  place.style.top = `${between(below + offsetHeight > height - MARGIN ? above : below, MARGIN, height - offsetHeight - MARGIN)}px`;
  $("offer-acts").firstElementChild.focus({ preventScroll: true });
}

function between(value, least, most) { return Math.max(least, Math.min(value, most)); }

/** Take the card away. */
export function close() {
  $("offer").hidden = true;
  dismiss?.();
  dismiss = null;
}
