/** Draws the map: grids, rooms, furniture, zones, station, way, lidar and robot. */
import { get } from "../store.js";
import { grid, version } from "./grids.js";
import { fit, toScreen, view } from "./view.js";

const canvas = document.getElementById("floor");
const context = canvas.getContext("2d");
const dark = matchMedia("(prefers-color-scheme: dark)");
const still = matchMedia("(prefers-reduced-motion: reduce)");
let from = null; // the pose before the newest one, to glide from
let last = null;
let drawn = "";

const INK = { light: "#2b2e33", dark: "#eceae6" };
const GLIDE = 110; // ms between two poses

/** Draw whenever something moved. */
export function begin() {
  new ResizeObserver(resize).observe(canvas);
  resize();
  requestAnimationFrame(frame);
}

/** Return a picture of what is seen now, as an address of a PNG. */
export function picture() { return canvas.toDataURL("image/png"); }

/** Let the whole home be seen. */
export function showAll() {
  const map = grid("map");
  if (!map) return;
  const box = bounds(map);
  if (box) fit(box);
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
  return [x + (left - 2) * size, y + (low - 2) * size, x + (right + 3) * size, y + (high + 3) * size];
}

function resize() {
  const ratio = devicePixelRatio || 1;
  view.width = canvas.clientWidth;
  view.height = canvas.clientHeight;
  canvas.width = Math.round(view.width * ratio);
  canvas.height = Math.round(view.height * ratio);
  drawn = "";
  if (!view.isFitted) showAll();
}

function frame(now) {
  requestAnimationFrame(frame);
  if (!view.isFitted) showAll();
  const state = get("state"), pose = state ? glided(state, now) : null;
  const key = [version(), view.x, view.y, view.scale, pose, get("trail").length, get("home")?.version, state?.time,
    get("chosen"), JSON.stringify(get("layers")), JSON.stringify(get("drawing")), dark.matches].join("|");
  if (key === drawn) return;
  drawn = key;
  draw(state, pose);
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

function draw(state, pose) {
  const ratio = devicePixelRatio || 1, layers = get("layers"), home = get("home");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, view.width, view.height);
  drawGrid("map");
  if (layers.coverage) drawGrid("coverage");
  if (layers.dirt) drawGrid("dirt");
  if (home) {
    if (layers.furniture) home.furniture.forEach(drawFurniture);
    if (layers.rooms) drawRooms(home);
    if (layers.zones) home.zones.forEach(drawZone);
    (home.changes ?? []).forEach(drawChange);
    drawStation(home);
  }
  drawDraft(get("drawing"));
  if (layers.trail) drawTrail(get("trail"));
  if (!state) return;
  if (layers.path) drawPath(state.path);
  if (layers.scan) drawScan(state.scan);
  if (home) drawRobot(pose, home.radius);
}

function drawGrid(name) {
  const layer = grid(name);
  if (!layer) return;
  const [x, y] = layer.origin, size = layer.resolution;
  const [left, top] = toScreen(x, y + layer.rows * size);
  context.imageSmoothingEnabled = false;
  context.drawImage(layer.canvas, left, top, layer.columns * size * view.scale, layer.rows * size * view.scale);
}

function trace(points, isClosed) {
  context.beginPath();
  points.forEach(([x, y], index) => {
    const [px, py] = toScreen(x, y);
    if (index) context.lineTo(px, py); else context.moveTo(px, py);
  });
  if (isClosed) context.closePath();
}

function drawFurniture(points) {
  trace(points, true);
  context.fillStyle = dark.matches ? "rgb(90 86 80 / 55%)" : "rgb(196 184 166 / 55%)";
  context.fill();
}

function drawRooms(home) {
  const chosen = get("chosen"), ink = dark.matches ? INK.dark : INK.light;
  for (const room of home.rooms) {
    const order = chosen.indexOf(room.name);
    for (const ring of room.rings) {
      trace(ring, true);
      if (order >= 0) {
        context.fillStyle = dark.matches ? "rgb(79 208 163 / 18%)" : "rgb(0 105 76 / 13%)";
        context.fill();
      }
      context.strokeStyle = order >= 0 ? (dark.matches ? "#4fd0a3" : "#00694c") : (dark.matches ? "#6a6f78" : "#b7ae9f");
      context.lineWidth = order >= 0 ? 2 : 1;
      context.stroke();
    }
    const [px, py] = toScreen(...room.anchor);
    const text = order >= 0 ? `${order + 1}  ${room.name}` : room.name;
    label(text, px, py, ink, order >= 0);
  }
}

function label(text, px, py, ink, isBold) {
  context.font = `${isBold ? "600 " : ""}14px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineWidth = 4;
  context.strokeStyle = dark.matches ? "rgb(29 31 34 / 85%)" : "rgb(255 255 255 / 85%)";
  context.strokeText(text, px, py);
  context.fillStyle = ink;
  context.fillText(text, px, py);
}

function drawZone(zone) {
  const isArea = zone.kind === "no-go";
  trace(zone.points, isArea);
  context.strokeStyle = dark.matches ? "#ffb066" : "#b34a00";
  context.lineWidth = isArea ? 2 : 4;
  context.setLineDash(isArea ? [6, 4] : []);
  context.stroke();
  context.setLineDash([]);
  if (isArea) {
    context.fillStyle = dark.matches ? "rgb(255 176 102 / 22%)" : "rgb(179 74 0 / 16%)";
    context.fill();
  }
}

/** Draw the outline of a thing that appeared, or is gone. */
function drawChange({ appeared, x, y, length, width }) {
  const [left, right, low, high] = [x - length / 2, x + length / 2, y - width / 2, y + width / 2];
  trace([[left, low], [right, low], [right, high], [left, high]], true);
  context.strokeStyle = dark.matches ? "#ffb066" : "#b34a00";
  context.lineWidth = 2;
  context.setLineDash([6, 4]);
  context.stroke();
  context.setLineDash([]);
  label(appeared ? "new" : "gone", ...toScreen(x, y), context.strokeStyle, true);
}

function drawDraft(drawing) {
  if (!drawing?.from || !drawing.to) return;
  const [[x, y], [toX, toY]] = [drawing.from, drawing.to];
  const isLine = drawing.kind === "wall" || drawing.kind === "split";
  trace(isLine ? [[x, y], [toX, toY]] : [[x, y], [toX, y], [toX, toY], [x, toY]], !isLine);
  context.strokeStyle = drawing.kind === "clean" ? (dark.matches ? "#4fd0a3" : "#00694c") : (dark.matches ? "#ffb066" : "#b34a00");
  context.lineWidth = 2;
  context.setLineDash([6, 4]);
  context.stroke();
  context.setLineDash([]);
}

function drawStation(home) {
  const [x, y, theta] = home.station, [px, py] = toScreen(x + 0.15 * Math.cos(theta), y + 0.15 * Math.sin(theta));
  const arm = Math.max(6, 0.1 * view.scale);
  context.strokeStyle = dark.matches ? INK.dark : INK.light;
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(px - arm, py); context.lineTo(px + arm, py);
  context.moveTo(px, py - arm); context.lineTo(px, py + arm);
  context.stroke();
}

function drawTrail(points) {
  const pieces = 8, newest = points.length;
  context.lineWidth = 1.25;
  context.lineJoin = "round";
  for (let piece = 0; piece < pieces; piece++) {
    const begins = Math.max(0, Math.floor(newest * piece / pieces) - 1), ends = Math.floor(newest * (piece + 1) / pieces);
    if (ends - begins < 2) continue;
    const strength = 0.12 + 0.5 * (piece + 1) / pieces;
    context.strokeStyle = dark.matches ? `rgb(236 234 230 / ${strength})` : `rgb(43 46 51 / ${strength})`;
    trace(points.slice(begins, ends), false);
    context.stroke();
  }
}

function pairs(flat) {
  const points = [];
  for (let index = 0; index < flat.length; index += 2) points.push([flat[index] / 100, flat[index + 1] / 100]);
  return points;
}

function drawPath(flat) {
  if (flat.length < 4) return;
  trace(pairs(flat), false);
  context.strokeStyle = dark.matches ? "rgb(124 196 255 / 70%)" : "rgb(0 96 168 / 55%)";
  context.lineWidth = 1.5;
  context.setLineDash([2, 5]);
  context.stroke();
  context.setLineDash([]);
}

function drawScan(flat) {
  context.fillStyle = dark.matches ? "#ffb066" : "#b34a00";
  for (const [x, y] of pairs(flat)) {
    const [px, py] = toScreen(x, y);
    context.fillRect(px - 1, py - 1, 2.5, 2.5);
  }
}

function drawRobot([x, y, theta], radius) {
  const [px, py] = toScreen(x, y), size = Math.max(7, radius * view.scale);
  context.beginPath();
  context.arc(px, py, size, 0, 2 * Math.PI);
  context.fillStyle = dark.matches ? "#eceae6" : "#3a3d42";
  context.fill();
  context.lineWidth = 2;
  context.strokeStyle = dark.matches ? "#1d1f22" : "#ffffff";
  context.stroke();
  context.beginPath();
  context.moveTo(px + size * 0.85 * Math.cos(theta), py - size * 0.85 * Math.sin(theta));
  context.lineTo(px + size * 0.3 * Math.cos(theta), py - size * 0.3 * Math.sin(theta));
  context.strokeStyle = dark.matches ? "#00694c" : "#7fe0bd";
  context.lineWidth = Math.max(3, size * 0.18);
  context.lineCap = "round";
  context.stroke();
  context.lineCap = "butt";
}
