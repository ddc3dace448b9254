/** Zones: what the robot must not enter, and what is to be cleaned once. */
import { $, button } from "../dom.js";
import { askFor, note, refuse, wish } from "../link.js";
import { toFloor, view } from "../map/view.js";
import { shifted, withCorner } from "../map/zones.js";
import { chosenZone, get, moveZone, on, set } from "../store.js";
import { title, ZONES } from "../words.js";
import { beginClean } from "./actions.js";
import { askName } from "./ask.js";
import * as card from "./card.js";
import { closed, opened } from "./opened.js";
import { undo } from "./rooms.js";
import * as sheet from "./sheet.js";

const DRAWS = { "draw-clean": "clean", "draw-no-go": "no-go", "draw-wall": "wall", "draw-carpet": "carpet" };
const HINTS = { clean: "Drag over the floor to be cleaned.", "no-go": "Drag over the floor that it shall not enter.", wall: "Drag a line that it shall not cross.", carpet: "Drag over the carpet.", split: "Drag a line through the room." };
const STEP = 0.1; // m that an arrow moves
const SAME = 0.001; // m by which a place may differ from what was asked for
const FIRST = 0.5; // m; half the side of what is drawn with keys

const wished = new Map(); // zones that are to be put where they were moved to, by their names
let isSending = false;
let settles = false; // whether the next home tells where the robot has what was moved

/** Connect the buttons, and keep the list up to date. */
export function begin() {
  for (const [id, kind] of Object.entries(DRAWS))
    $(id).onclick = (event) => draw(get("drawing")?.kind === kind ? null : { kind }, event);
  $("split").onclick = (event) => draw({ kind: "split", room: get("chosen")[0] }, event);
  $("hint-cancel").onclick = () => set("drawing", null);
  on("home", () => { if (settles && !isSending) settle(); });
  on("home zone", showZones);
  on("drawing", showDrawing);
  on("limits", () => { for (const part of document.querySelectorAll("[data-part=zones], [data-tab=zones]")) part.hidden = get("limits")?.most_zones === 0; });
  for (const name of ["drawing", "zone"]) on(name, () => (get(name) ? opened(name, () => set(name, null)) : closed(name)));
}

function draw(drawing, event) {
  if (event.detail === 0) $("floor").focus(); // with keys it is drawn on the map
  set("zone", null);
  set("drawing", drawing);
}

/** Ask for what a draft on the map stands for. */
export function drawn(draft) {
  if (draft.kind === "any") { offerKinds(draft); return; }
  set("drawing", null);
  make(draft);
}

function offerKinds(draft) {
  const as = (kind) => () => { set("drawing", null); make({ ...draft, kind }); };
  card.open("What shall this be?", [
    ["Clean it now", as("clean")], ["No-go zone", as("no-go")], ["Virtual wall", as("wall")], ["Carpet", as("carpet")], ["Nothing", () => set("drawing", null)],
  ], draft.to, () => set("drawing", null));
}

async function make({ kind, room, from, to }) {
  if (kind === "split") {
    if (!await wish("rooms/split", { name: room, start: from, end: to })) return;
    set("chosen", []);
    note(`${title(room)} is split.`, undo);
    return;
  }
  const [left, right] = [Math.min(from[0], to[0]), Math.max(from[0], to[0])];
  const [low, high] = [Math.min(from[1], to[1]), Math.max(from[1], to[1])];
  if (kind === "clean") return beginClean({ mode: "zones", zones: [[left, low, right, high]] });
  const points = kind === "wall" ? [from, to] : [[left, low], [right, low], [right, high], [left, high]];
  const name = newName(kind);
  if (await wish("zones", { name, kind, points }, "PUT")) note(`${name} is drawn. Tap it to move it.`, () => wish(path(name), {}, "DELETE"));
}

/** Put the chosen zone where it was moved to: one wish at a time, and then the newest place. */
export async function moved() {
  const chosen = chosenZone();
  if (chosen) wished.set(chosen.name, chosen);
  if (isSending) return;
  isSending = settles = true;
  let isSettled = true;
  for (const [name, zone] of wished) {
    wished.delete(name);
    isSettled = !await wish("zones", zone, "PUT") || isThere(zone);
  }
  isSending = false;
  if (isSettled) settle();
}

/** Whether the robot has told already that it has a zone there. */
function isThere({ name, points }) {
  const told = get("home").zones.find((one) => one.name === name);
  return Boolean(told) && told.points.every(([x, y], index) => Math.hypot(x - points[index][0], y - points[index][1]) < SAME);
}

/** From now on the chosen zone is where the robot has it. */
function settle() {
  settles = false;
  moveZone(null);
}

/** Choose a zone, to be moved or removed. */
export function select(zone) { set("zone", { name: zone.name, points: null }); }

/** Remove a zone; it can be brought back. */
export async function remove(zone) {
  if (!await wish(path(zone.name), {}, "DELETE")) return;
  wished.delete(zone.name);
  set("zone", null);
  note(`${zone.name} is removed.`, () => wish("zones", zone, "PUT"));
}

/** Let a zone have another name. */
function rename(zone) {
  const isTaken = (name) => get("home").zones.some((one) => one.name === name);
  const take = async (name) => {
    if (name === zone.name) return "";
    return isTaken(name) ? `there is a zone “${name}” already` : giveName(zone, name);
  };
  return askName(`Another name for ${zone.name}`, zone.name, take, (name, late) => {
    if (name === zone.name) return;
    const back = async () => { const fault = await giveName({ ...zone, name }, zone.name); if (fault) refuse(fault); };
    note(`${late}${zone.name} is ${name} now.`, back);
  });
}

/** Returns why it is refused; the zone of the old name goes last, so that the robot is kept out all the time. */
async function giveName(zone, name) {
  const now = get("home").zones.find((one) => one.name === zone.name) ?? zone; // it may have been moved meanwhile
  const refused = await askFor("zones", { ...now, name }, "PUT");
  if (refused) return refused;
  const kept = await askFor(path(zone.name), {}, "DELETE");
  if (kept) await askFor(path(name), {}, "DELETE");
  return kept;
}

/** Offer what can be done with the zone that is chosen. */
export function offerZone(zone) {
  select(zone);
  const now = () => chosenZone() ?? zone;
  card.open(`${zone.name}: drag it, or a corner`, [["Rename", () => rename(now())], ["Remove", () => remove(now())], ["Done", () => set("zone", null)]], zone.points[0]);
}

/** Draw or move with keys; returns whether the key meant something here. */
export function key(event) {
  const draft = get("drawing"), zone = chosenZone();
  const [dx, dy] = { ArrowUp: [0, STEP], ArrowDown: [0, -STEP], ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0] }[event.key] ?? [0, 0];
  const ends = ["Delete", "Backspace"].includes(event.key);
  if (draft) {
    if (ends) set("drawing", null);
    else if (event.key === "Enter" && !draft.from) set("drawing", { ...draft, ...inTheMiddle(draft) });
    else if (event.key === "Enter") drawn(draft);
    else if ((dx || dy) && draft.from) {
      const move = ([x, y]) => [x + dx, y + dy];
      set("drawing", { ...draft, from: event.shiftKey ? draft.from : move(draft.from), to: move(draft.to) });
    } else return false;
    return true;
  }
  if (!zone) return false;
  if (ends) remove(zone);
  else if (event.key === "Enter") set("zone", null);
  else if (dx || dy) {
    const corner = zone.points.length === 2 ? 1 : 2, [x, y] = zone.points[corner];
    moveZone((event.shiftKey ? withCorner(zone, corner, x + dx, y + dy) : shifted(zone, dx, dy)).points);
    moved();
  } else return false;
  return true;
}

function inTheMiddle(draft) {
  const room = get("home")?.rooms.find((one) => one.name === (draft.room ?? get("chosen")[0]));
  const [x, y] = room?.anchor ?? toFloor(view.width / 2, view.height / 2);
  return { from: [x - FIRST, y - FIRST], to: [x + FIRST, y + FIRST] };
}

function path(name) { return `zones/${encodeURIComponent(name)}`; }

/** A name that no zone has yet. */
export function newName(kind) {
  const names = (get("home")?.zones ?? []).map((zone) => zone.name), word = { wall: "Wall", carpet: "Carpet" }[kind] ?? "Zone";
  let number = 1;
  while (names.includes(`${word} ${number}`)) number++;
  return `${word} ${number}`;
}

function showDrawing() {
  const drawing = get("drawing"), kind = drawing?.kind;
  for (const [id, own] of Object.entries(DRAWS)) $(id).setAttribute("aria-pressed", String(kind === own));
  $("floor").classList.toggle("drawing", Boolean(kind));
  const byKeys = drawing?.from ? "Arrows move it, Shift and arrows its size; Enter accepts." : "With keys: Enter begins.";
  if (kind in HINTS && $("hint").hidden) sheet.open(null); // it would lie over the map
  $("hint").hidden = !(kind in HINTS);
  $("hint-text").textContent = kind in HINTS ? `${HINTS[kind]} ${document.activeElement === $("floor") ? byKeys : ""}` : "";
}

function showZones() {
  const zones = get("home")?.zones ?? [], selected = get("zone");
  if (selected && !zones.some((zone) => zone.name === selected.name)) { set("zone", null); return; }
  const focused = document.activeElement?.dataset?.zone;
  $("zones").replaceChildren(...zones.map((zone) => {
    const item = document.createElement("li");
    const pick = button(`${zone.name} (${ZONES[zone.kind] ?? zone.kind})`, () => (selected?.name === zone.name ? set("zone", null) : select(zone)), `Move ${zone.name}`);
    pick.className = "pick";
    pick.dataset.zone = zone.name;
    pick.setAttribute("aria-pressed", String(selected?.name === zone.name));
    const acts = [button("Remove", () => remove(zone), `Remove ${zone.name}`)];
    if (selected?.name === zone.name) acts.unshift(button("Rename", () => rename(zone), `Rename ${zone.name}`));
    for (const act of acts) act.classList.add("live-only");
    item.append(pick, ...acts);
    return item;
  }));
  if (focused) [...$("zones").querySelectorAll("button")].find((one) => one.dataset.zone === focused)?.focus();
}
