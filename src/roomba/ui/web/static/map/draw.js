/** Puts the map together: layers that are drawn anew only when their data changed, and what moves. */
import { get, openEdges } from "../store.js";
import { grid, repaint, version } from "./grids.js";
import { drawDraft, drawState, drawTrail } from "./moving.js";
import { palette } from "./palette.js";
import { drawGrid, drawGround, drawThings } from "./plan.js";
import { bound, fit, view } from "./view.js";

const canvas = document.getElementById("floor");
const context = canvas.getContext("2d");
const still = matchMedia("(prefers-reduced-motion: reduce)");
const GLIDE = 110; // ms between two poses

let from = null; // the pose before the newest one, to glide from
let last = null;
let drawn = "";
let bounded = -1;
let colours = null; // those by which all is drawn

/** Layers from below: when each has to be drawn anew, and how. */
const LAYERS = [
  { when: () => [version("map"), get("home")?.number], paint: drawGround },
  { when: () => [version("coverage"), version("dirt"), version("true dirt"), get("trail").length, get("trail").at(-1)], paint: drawSwept },
  { when: () => [get("home")?.number, get("chosen"), JSON.stringify(get("zone")), JSON.stringify(openEdges()), get("edge")], paint: drawThings },
].map((layer) => ({ ...layer, canvas: document.createElement("canvas"), key: "" }));

/** Draw whenever something moved. */
export function begin() {
  new ResizeObserver(resize).observe(canvas);
  resize();
  requestAnimationFrame(frame);
}

/** Return a picture of what is seen now, as an address of a PNG. */
export function picture() {
  const whole = document.createElement("canvas"), paper = whole.getContext("2d");
  whole.width = canvas.width;
  whole.height = canvas.height;
  paper.fillStyle = palette().paper;
  paper.fillRect(0, 0, whole.width, whole.height);
  paper.drawImage(canvas, 0, 0);
  return whole.toDataURL("image/png");
}

function drawSwept(onto) {
  const layers = get("layers");
  if (layers.coverage) drawGrid(onto, "coverage", true);
  if (layers.dirt) drawGrid(onto, "dirt", true);
  if (layers.truth) drawGrid(onto, "true dirt", true);
  if (layers.trail) drawTrail(onto);
}

/** Keep the view near the home, and show the whole of it until the viewer moves it. */
function follow() {
  if (bounded !== version("map")) {
    bounded = version("map");
    const map = grid("map"), box = map && bounds(map);
    if (box) bound(box);
  }
  if (!view.isFitted) fit();
}

function bounds(map) {
  let left = Infinity, right = -Infinity, low = Infinity, high = -Infinity;
  for (let row = 0; row < map.rows; row++)
    for (let column = 0; column < map.columns; column++)
      if (map.cells[row * map.columns + column]) {
        if (column < left) left = column;
        if (column > right) right = column;
        if (row < low) low = row;
        if (row > high) high = row;
      }
  if (left > right) return null;
  const [x, y] = map.origin, size = map.resolution;
  return [x + left * size, y + low * size, x + (right + 1) * size, y + (high + 1) * size];
}

function resize() {
  const ratio = devicePixelRatio || 1;
  view.width = canvas.clientWidth;
  view.height = canvas.clientHeight;
  for (const one of [canvas, ...LAYERS.map((layer) => layer.canvas)]) {
    one.width = Math.round(view.width * ratio);
    one.height = Math.round(view.height * ratio);
  }
  drawn = "";
  for (const layer of LAYERS) layer.key = "";
}

function frame(now) {
  requestAnimationFrame(frame);
  follow();
  if (colours !== palette()) { // an event for this may be lost
    colours = palette();
    repaint();
  }
  const state = get("state"), pose = state ? glided(state, now) : null;
  const seen = [view.x, view.y, view.scale, JSON.stringify(get("layers")), colours.paper].join("|");
  let isNew = false;
  for (const layer of LAYERS) {
    const key = `${seen}|${layer.when().join("|")}`;
    if (key === layer.key) continue;
    layer.key = key;
    isNew = true;
    paint(layer.canvas.getContext("2d"), layer.paint);
  }
  const key = [seen, pose, state?.at, JSON.stringify(get("drawing")), get("carried")].join("|");
  if (key === drawn && !isNew) return;
  drawn = key;
  paint(context, () => compose(state, pose));
}

function paint(onto, draw) {
  const ratio = devicePixelRatio || 1;
  onto.setTransform(ratio, 0, 0, ratio, 0, 0);
  onto.clearRect(0, 0, view.width, view.height);
  draw(onto);
}

function compose(state, pose) {
  for (const layer of LAYERS) context.drawImage(layer.canvas, 0, 0, view.width, view.height);
  drawDraft(context);
  if (state) drawState(context, state, pose, get("home"));
}

/** Return the pose between the last two, so that the robot glides and is never ahead of them. */
function glided(state, now) {
  if (!last || state.at !== last.at) {
    from = last && Math.hypot(state.pose[0] - last.pose[0], state.pose[1] - last.pose[1]) < 1 ? last : null;
    last = state;
  }
  if (!from || still.matches) return state.pose;
  const share = Math.min(1, (now - state.at) / GLIDE);
  const turn = Math.atan2(Math.sin(state.pose[2] - from.pose[2]), Math.cos(state.pose[2] - from.pose[2]));
  return [
    from.pose[0] + share * (state.pose[0] - from.pose[0]),
    from.pose[1] + share * (state.pose[1] - from.pose[1]),
    from.pose[2] + share * turn,
  ];
}
