/** The tools of the map: zoom, layers, scale, a picture to save. */
import { $ } from "../dom.js";
import * as draw from "../map/draw.js";
import { view, zoom } from "../map/view.js";
import { get, set } from "../store.js";

const NAMES = { coverage: "Coverage", trail: "Way so far", path: "Way to go", rooms: "Rooms", furniture: "Furniture", zones: "Zones", dirt: "Dirt found", scan: "Lidar" };
const STEP = 1.4;

/** Connect the tools. */
export function begin() {
  $("nearer").onclick = () => zoom(STEP);
  $("farther").onclick = () => zoom(1 / STEP);
  $("whole").onclick = () => { view.isFitted = false; };
  $("picture").onclick = save;
  for (const [name, words] of Object.entries(NAMES)) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = get("layers")[name];
    box.onchange = () => set("layers", { ...get("layers"), [name]: box.checked });
    label.append(box, words);
    $("layers").append(label);
  }
  setInterval(scale, 250);
}

function save() {
  const link = document.createElement("a");
  link.href = draw.picture();
  link.download = `${get("home")?.name ?? "home"}.png`;
  link.click();
}

function scale() {
  const metres = [0.2, 0.5, 1, 2, 5, 10, 20].find((length) => length * view.scale > 60) ?? 50;
  $("scale-bar").style.width = `${metres * view.scale}px`;
  $("scale-text").textContent = `${metres} m`;
}
