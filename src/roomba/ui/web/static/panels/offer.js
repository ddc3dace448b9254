/** What can be done at a place that was tapped, and only that. */
import { $ } from "../dom.js";
import { wish } from "../link.js";
import { isKnown } from "../map/grids.js";
import { isInside, zoneAt } from "../map/zones.js";
import { get, mayAsk, mayMove, offers, set } from "../store.js";
import { title } from "../words.js";
import { beginClean } from "./actions.js";
import { open } from "./card.js";
import { toggle } from "./rooms.js";
import { offerZone } from "./zones.js";

const NEAR = 0.4; // m from a door's middle that still mean it

/** Choose the room at (x, y), m, or the zone, and offer what else can be done at these pixels. */
export function tapped(x, y, px, py) {
  if (!mayAsk()) return;
  const zone = zoneAt(x, y, px, py);
  set("zone", null);
  if (zone) { offerZone(zone); return; }
  const before = get("chosen"), room = roomAt(x, y);
  if (room) toggle(room.name);
  const order = get("chosen").indexOf(room?.name);
  const choice = order >= 0 ? ` is number ${order + 1}` : " is left out";
  offerPlace(x, y, room ? title(room.name) + choice : "Here", before);
}

/** Offer what can be done at a place, without choosing a room. */
export function offerAt(x, y) { offerPlace(x, y, title(roomAt(x, y)?.name ?? "here"), get("chosen")); }

function roomAt(x, y) { return get("home")?.rooms.find((one) => isInside(one.rings, x, y)); }

/** Offer what can be done at a place of the map; rooms are chosen as `before` when it was the place that was meant. */
function offerPlace(x, y, name, before) {
  if (!isKnown(x, y) || !mayMove()) return;
  open(name, [
    ["Go here", () => wish("go", { x, y })],
    ["Clean here", () => beginClean({ mode: "spot", spot: [x, y] })],
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
