/** Where the map stays open after the last run: a list of which each shows its place on the map. */
import { $, span } from "../dom.js";
import { centre } from "../map/view.js";
import { on, openEdges, get, set } from "../store.js";
import { edgeText, letter } from "../words.js";
import { open } from "./sheet.js";

let shown = "";

/** Keep the list up to date. */
export function begin() {
  on("state", show);
  on("edge", mark);
}

function show() {
  const edges = openEdges(), key = JSON.stringify(edges);
  $("last-open").hidden = edges.length === 0;
  if (key === shown) return;
  shown = key;
  $("last-edges").replaceChildren(...edges.map(entry));
  set("edge", null);
}

function entry(edge, index) {
  const item = document.createElement("li"), pick = document.createElement("button");
  pick.type = "button";
  pick.className = "pick";
  pick.append(span("order", letter(index)), span("words", edgeText(edge)));
  pick.onclick = () => choose(edge, index);
  item.append(pick);
  return item;
}

/** Show the place of one, or let go of it; on a phone the sheet lies over the map. */
function choose({ x, y }, index) {
  if (get("edge") === index) { set("edge", null); return; }
  set("edge", index);
  set("layers", { ...get("layers"), edges: true });
  open(null);
  centre(x, y);
}

function mark() {
  [...$("last-edges").querySelectorAll("button")].forEach((pick, index) => pick.setAttribute("aria-pressed", String(get("edge") === index)));
}
