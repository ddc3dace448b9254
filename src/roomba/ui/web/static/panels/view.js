/** The tools of the map: zoom, layers, scale, a picture to save. */
import { $ } from "../dom.js";
import * as draw from "../map/draw.js";
import { onColours, palette } from "../map/palette.js";
import { view, zoom } from "../map/view.js";
import { get, on, openEdges, set } from "../store.js";

const NAMES = { coverage: "Clean: once, twice, more", trail: "Way so far", path: "Way to go", rooms: "Rooms", furniture: "Furniture", zones: "Zones", carpets: "Carpets it felt", edges: "Where the map is open", dirt: "Dirt found", scan: "Lidar", truth: "The truth" };
const STEP = 1.4;

/** Connect the tools. */
export function begin() {
  $("nearer").onclick = () => zoom(STEP);
  $("farther").onclick = () => zoom(1 / STEP);
  $("whole").onclick = () => { view.isFitted = false; };
  $("picture").onclick = save;
  const boxes = {};
  for (const [name, words] of Object.entries(NAMES)) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = get("layers")[name];
    box.onchange = () => set("layers", { ...get("layers"), [name]: box.checked });
    label.append(box, words);
    boxes[name] = label;
    $("layers").append(label);
  }
  boxes.coverage.append(swatches());
  on("layers", () => { for (const [name, label] of Object.entries(boxes)) label.firstElementChild.checked = get("layers")[name]; });
  on("state", () => {
    boxes.truth.hidden = !get("state")?.truth;
    boxes.edges.hidden = openEdges().length === 0;
  });
  setInterval(scale, 250);
}

function swatches() {
  const place = document.createElement("span");
  place.className = "swatches";
  place.setAttribute("aria-hidden", "true");
  const fill = () => place.replaceChildren(...palette().cells.swept.map((colour) => {
    const swatch = document.createElement("i");
    swatch.style.background = `rgb(${colour.join(" ")})`;
    return swatch;
  }));
  onColours(fill);
  fill();
  return place;
}

function save() {
  const link = document.createElement("a");
  link.href = draw.picture();
  link.download = `${get("home")?.name ?? "home"}.png`;
  link.click();
}

function scale() {
  const metres = [0.2, 0.5, 1, 2, 5, 10, 20].find((length) => length * view.scale > 40) ?? 50;
  $("scale-bar").style.width = `${metres * view.scale}px`;
  $("scale-text").textContent = `${metres} m`;
}
