/** The rooms: choose them in order, rename, join, split. */
import { $ } from "../dom.js";
import { wish } from "../link.js";
import { get, on, set } from "../store.js";
import { askName } from "./ask.js";

/** Keep the list up to date. */
export function begin() {
  $("rename").onclick = rename;
  $("join").onclick = join;
  $("split").onclick = () => set("drawing", { kind: "split", room: get("chosen")[0] });
  on("home chosen", show);
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

async function rename() {
  const [name] = get("chosen");
  const given = await askName(`Another name for ${name}`, name);
  if (given && given !== name && await wish("rooms/rename", { name, new_name: given })) set("chosen", []);
}

async function join() {
  if (await wish("rooms/join", { names: get("chosen") })) set("chosen", []);
}

function show() {
  const rooms = get("home")?.rooms ?? [], names = rooms.map((room) => room.name);
  const chosen = get("chosen").filter((name) => names.includes(name));
  if (chosen.length !== get("chosen").length) { set("chosen", chosen); return; }
  $("rooms-hint").textContent = rooms.length
    ? "Choose rooms in the order in which they shall be cleaned."
    : "There are no rooms yet: the robot finds them when its map is whole.";
  $("room-actions").hidden = chosen.length === 0;
  $("rename").disabled = chosen.length !== 1;
  $("split").disabled = chosen.length !== 1;
  $("join").disabled = chosen.length < 2;
  const focused = document.activeElement?.dataset?.room;
  $("rooms").replaceChildren(...rooms.map((room) => entry(room, chosen.indexOf(room.name))));
  if (focused) [...$("rooms").querySelectorAll("button")].find((one) => one.dataset.room === focused)?.focus();
}

function entry(room, order) {
  const item = document.createElement("li"), button = document.createElement("button");
  button.type = "button";
  button.className = "room";
  button.dataset.room = room.name;
  button.setAttribute("aria-pressed", String(order >= 0));
  button.append(part("order", order >= 0 ? String(order + 1) : ""), part("name", room.name), part("area", `${room.area.toFixed(1)} m²`));
  button.onclick = () => toggle(room.name);
  item.append(button);
  return item;
}

function part(kind, text) {
  const span = document.createElement("span");
  span.className = kind;
  span.textContent = text;
  return span;
}
