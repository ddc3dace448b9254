/** What can be done at a place that was tapped, and only that. */
import { $ } from "../dom.js";
import { wish } from "../link.js";
import { isInside, zoneAt } from "../map/zones.js";
import { get, offers, set } from "../store.js";
import { title } from "../words.js";
import { how } from "./actions.js";
import { open } from "./card.js";
import { isShown } from "./replay.js";
import { toggle } from "./rooms.js";
import { offerZone } from "./zones.js";

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
