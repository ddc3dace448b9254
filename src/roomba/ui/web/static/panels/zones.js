/** Zones: what the robot must not enter, and what is to be cleaned once. */
import { $ } from "../dom.js";
import { wish } from "../link.js";
import { get, on, set } from "../store.js";
import { how } from "./actions.js";

const DRAWS = { "draw-clean": "clean", "draw-no-go": "no-go", "draw-wall": "wall" };

/** Connect the buttons, and keep the list up to date. */
export function begin() {
  for (const [id, kind] of Object.entries(DRAWS))
    $(id).onclick = () => set("drawing", get("drawing")?.kind === kind ? null : { kind });
  on("home", showZones);
  on("drawing", showDrawing);
}

/** Ask for what a draft on the map stands for. */
export function drawn({ kind, room, from, to }) {
  if (kind === "split") return wish("rooms/split", { name: room, start: from, end: to });
  const [left, right] = [Math.min(from[0], to[0]), Math.max(from[0], to[0])];
  const [low, high] = [Math.min(from[1], to[1]), Math.max(from[1], to[1])];
  if (kind === "clean") return wish("clean", { mode: "zones", zones: [[left, low, right, high]], ...how() });
  const points = kind === "wall" ? [from, to] : [[left, low], [right, low], [right, high], [left, high]];
  return wish("zones", { name: newName(kind), kind, points }, "PUT");
}

function newName(kind) {
  const names = (get("home")?.zones ?? []).map((zone) => zone.name), word = kind === "wall" ? "Wall" : "Zone";
  let number = 1;
  while (names.includes(`${word} ${number}`)) number++;
  return `${word} ${number}`;
}

function showDrawing() {
  const kind = get("drawing")?.kind;
  for (const [id, own] of Object.entries(DRAWS)) $(id).setAttribute("aria-pressed", String(kind === own));
  $("floor").classList.toggle("drawing", Boolean(kind));
}

function showZones() {
  $("zones").replaceChildren(...(get("home")?.zones ?? []).map((zone) => {
    const item = document.createElement("li"), name = document.createElement("span"), remove = document.createElement("button");
    name.className = "name";
    name.textContent = `${zone.name} (${zone.kind === "wall" ? "virtual wall" : "no-go"})`;
    remove.type = "button";
    remove.textContent = "Remove";
    remove.setAttribute("aria-label", `Remove ${zone.name}`);
    remove.onclick = () => wish(`zones/${encodeURIComponent(zone.name)}`, {}, "DELETE");
    item.append(name, remove);
    return item;
  }));
}
