/** The robot's saved maps, and what it offers to change of the one that it goes by. */
import { $, put } from "../dom.js";
import { ask, askFor, note, wish } from "../link.js";
import { get, on } from "../store.js";
import { askName, askYes } from "./ask.js";
import { open } from "./sheet.js";

/** Connect the buttons, and keep the offer up to date. */
export function begin() {
  on("hasMaps", () => { $("maps").hidden = !get("hasMaps"); });
  $("maps").ontoggle = showMaps;
  $("map-save").onclick = save;
  $("map-accept").onclick = async () => { if (await wish("maps/change", { accept: true })) note("The map is changed.", () => wish("maps/undo")); };
  $("map-refuse").onclick = async () => { if (await wish("maps/change", { accept: false })) note("The map stays as it is."); };
  on("home", () => { showOffer(); showMaps(); });
}

function showOffer() {
  const changes = get("home")?.changes ?? [];
  $("map-offer").hidden = changes.length === 0;
  if (changes.length && !document.querySelector(".panel").dataset.open) open("rooms");
  const appeared = changes.filter((change) => change.appeared).length, gone = changes.length - appeared;
  const parts = [[appeared, "new"], [gone, "gone"]].filter(([count]) => count).map(([count, what]) => `${count} ${what}`);
  put($("map-offer-text"), `Something stands otherwise than on the map (${parts.join(", ")}): see the dashed outlines. Change the map?`);
}

/** Show which maps there are, while the list is open. */
async function showMaps() {
  if (!$("maps").open) return;
  const maps = await ask("maps");
  if (!maps) return;
  $("map-none").hidden = maps.names.length > 0;
  $("map-list").replaceChildren(...maps.names.map((name) => entry(name, name === maps.selected)));
}

function entry(name, isUsed) {
  const item = document.createElement("li"), text = document.createElement("span");
  text.className = "name";
  text.textContent = isUsed ? `${name} (in use)` : name;
  item.append(text);
  if (!isUsed) item.append(button("Use", `Use ${name}`, () => wish("maps/load", { name })));
  item.append(button("Remove", `Remove the map ${name}`, async () => {
    if (await askYes(`Forget the map ${name}? This cannot be undone.`)) await wish(`maps/${encodeURIComponent(name)}`, {}, "DELETE");
  }));
  return item;
}

function button(text, label, act) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  made.setAttribute("aria-label", label);
  made.onclick = async () => { await act(); await showMaps(); };
  return made;
}

function save() {
  return askName("Save the map as", "", (name) => askFor("maps/save", { name }), (name, late) => {
    if (late) note(`${late}the map is saved as ${name}.`);
    showMaps();
  });
}
