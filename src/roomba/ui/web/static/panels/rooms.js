/** The rooms: choose them in order, each its own way; rename, join, split. */
import { $, offer, span } from "../dom.js";
import { askFor, note, wish } from "../link.js";
import { get, on, set } from "../store.js";
import { title } from "../words.js";
import { how, numbers } from "./actions.js";
import { askName } from "./ask.js";
import { movers } from "./order.js";

let known = []; // the rooms as they were before

/** Keep the list up to date. */
export function begin() {
  $("rename").onclick = rename;
  $("join").onclick = join;
  on("home", follow);
  on("home chosen limits", show);
}

/** Keep the choice, and how each is cleaned, when rooms become others: one of the same outline has another name, else say that it is gone. */
function follow() {
  const rooms = get("home")?.rooms ?? [], before = new Map(known.map((room) => [room.name, JSON.stringify(room.rings)]));
  known = rooms;
  const nowOf = (name) => rooms.find((room) => room.name === name) ?? rooms.find((room) => JSON.stringify(room.rings) === before.get(name));
  const chosen = get("chosen"), gone = chosen.filter((name) => !nowOf(name));
  if (chosen.length) set("chosen", chosen.map((name) => nowOf(name)?.name).filter(Boolean));
  set("hows", Object.fromEntries(Object.entries(get("hows")).map(([name, own]) => [nowOf(name)?.name ?? name, own])));
  if (gone.length) note(`${gone.map(title).join(", ")}: no longer a room, and not chosen any more.`);
}

/** Choose a room as the next one, or leave it out again. */
export function toggle(name) {
  const chosen = get("chosen");
  set("chosen", chosen.includes(name) ? chosen.filter((one) => one !== name) : [...chosen, name]);
}

/** Choose the room of a number, from 1. */
export function toggleNumber(number) {
  const room = get("home")?.rooms[number - 1];
  if (room) toggle(room.name);
}

function rename() {
  const [name] = get("chosen");
  const take = async (given) => (given === name ? "" : askFor("rooms/rename", { name, new_name: given }));
  return askName(`Another name for ${name}`, name, take, (given, late) => {
    if (given === name) return;
    if (!late) set("chosen", []);
    note(`${late}${name} is ${given} now.`, () => wish("rooms/rename", { name: given, new_name: name }));
  });
}

async function join() {
  const names = get("chosen");
  if (!await wish("rooms/join", { names })) return;
  set("chosen", []);
  note(`${title(names[0])} and ${names.length > 2 ? "the others" : names[1]} are one room now.`, undo);
}

/** Take back the newest edit of the rooms. */
export function undo() { return wish("rooms/undo"); }

function show() {
  const rooms = get("home")?.rooms ?? [], chosen = get("chosen");
  $("rooms-hint").parentElement.hidden = !rooms.length && get("limits")?.explores === false; // it will never find any
  $("rooms-hint").textContent = !get("home") ? "" : rooms.length
    ? "Tap them, here or on the map, in the order in which they shall be cleaned."
    : "There are no rooms yet: the robot finds them when its map is whole.";
  $("room-actions").hidden = chosen.length === 0;
  $("rename").disabled = chosen.length !== 1;
  $("split").disabled = chosen.length !== 1;
  $("join").disabled = chosen.length < 2;
  const focused = $("rooms").contains(document.activeElement) ? nameOf(document.activeElement) : null;
  $("rooms").replaceChildren(...rooms.map((room) => entry(room, chosen.indexOf(room.name))));
  if (focused) focus(focused);
}

function nameOf(control) { return control.getAttribute("aria-label") ?? control.dataset.room; }

/** Keep the focus: a room that comes first cannot come earlier, and may then come later again. */
function focus(name) {
  const again = [...$("rooms").querySelectorAll("button, select")].find((one) => nameOf(one) === name);
  (again?.disabled ? again.parentElement.querySelector("button.mover:enabled") : again)?.focus();
}

function entry(room, order) {
  const item = document.createElement("li"), choice = document.createElement("button");
  choice.type = "button";
  choice.className = "room";
  choice.dataset.room = room.name;
  choice.setAttribute("aria-pressed", String(order >= 0));
  choice.append(span("order", order >= 0 ? String(order + 1) : ""), span("name", room.name), span("area", `${room.area.toFixed(1)} m²`));
  choice.onclick = () => toggle(room.name);
  item.append(choice);
  const limits = get("limits"), chosen = get("chosen");
  if (order >= 0 && limits?.each_room) {
    item.append(
      own(room.name, "passes", numbers(limits.most_passes).map(([value]) => [value, `${value} ×`]), `Passes of ${room.name}`, Number),
      own(room.name, "fan", limits.fans.map((fan) => [fan, fan]), `Fan of ${room.name}`, String),
    );
  }
  if (order >= 0 && chosen.length > 1) item.append(...movers(chosen, order, (names) => set("chosen", names), (text) => `Clean ${text}`));
  return item;
}

/** Return a choice that holds for one room. */
function own(name, what, options, label, read) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", label);
  offer(select, options, get("hows")[name]?.[what] ?? how()[what]);
  select.onchange = () => set("hows", { ...get("hows"), [name]: { ...get("hows")[name], [what]: read(select.value) } });
  return select;
}
