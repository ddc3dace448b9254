/** Playing with a simulated home, for teaching: what is done there, and the truth over the belief. */
import { $, button } from "../dom.js";
import { note, wish } from "../link.js";
import { get, offers, on, set } from "../store.js";
import { title } from "../words.js";

const EVERYWHERE = { block: ["Block the station", "play/block"], clear: ["Clear away", "play/clear"] };
const AT_A_PLACE = { spill: "spill dirt", chair: "put a chair", lift: "put the robot there" };

let doors = "";

/** Show what the robot offers. */
export function begin() {
  on("limits", show);
  on("state limits", showDoors);
  $("play-truth").onchange = () => set("layers", { ...get("layers"), truth: $("play-truth").checked });
  on("layers", () => { $("play-truth").checked = get("layers").truth; });
}

/** Whether the robot may be dragged on the map. */
export function mayCarry() { return $("play").open && offers("lift") && !get("state")?.replay; }

/** Follow the robot that is dragged: it is lifted, and put down at (x, y), m. */
export async function carried(what, x, y) {
  const state = get("state"), [backX, backY, theta] = state.truth?.pose ?? state.pose;
  if (what === "begin") await wish("play/lift");
  else if (what === "end") await wish("play/put", { x, y, theta });
  else await wish("play/put", { x: backX, y: backY, theta });
}

function show() {
  const acts = get("limits")?.play ?? [];
  $("play").hidden = acts.length === 0;
  const places = Object.keys(AT_A_PLACE).filter((act) => acts.includes(act)).map((act) => AT_A_PLACE[act]);
  $("play-hint").textContent = `While this is open, tap the floor to ${places.join(", ")}; ${acts.includes("lift") ? "or drag the robot." : ""}`;
  $("play-acts").replaceChildren(...Object.entries(EVERYWHERE).filter(([act]) => acts.includes(act)).map(([, [words, path]]) => button(words, async () => {
    if (await wish(path)) note(words === "Clear away" ? "What was put down is taken away." : "A box stands before the station.");
  })));
}

function showDoors() {
  const truth = get("state")?.truth, shown = (offers("door") && truth?.doors) || [], key = JSON.stringify(shown);
  $("play-truth-label").hidden = !truth;
  if (key === doors) return;
  doors = key;
  const focused = document.activeElement?.dataset?.door;
  $("play-doors").replaceChildren(...shown.map((door) => {
    const item = document.createElement("li"), name = document.createElement("span");
    name.className = "name";
    name.textContent = `${title(door.name)}: ${door.is_shut ? "shut" : "open"}`;
    const move = button(door.is_shut ? "Open" : "Shut", () => wish("play/door", { name: door.name, is_shut: !door.is_shut }), `${door.is_shut ? "Open" : "Shut"} the ${door.name}`);
    move.dataset.door = door.name;
    item.append(name, move);
    return item;
  }));
  if (focused) [...$("play-doors").querySelectorAll("button")].find((one) => one.dataset.door === focused)?.focus();
}
