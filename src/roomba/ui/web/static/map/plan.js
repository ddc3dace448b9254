/** Draws what seldom changes: walls, floors, furniture, rooms, zones, station. */
import { chosenZone, get, openEdges } from "../store.js";
import { letter, title } from "../words.js";
import { floorFill } from "./floors.js";
import { grid } from "./grids.js";
import { palette } from "./palette.js";
import { dashed, trace, traceAll, write } from "./trace.js";
import { toScreen, view } from "./view.js";

const WIDE = 45; // pixels per metre from which rooms tell their area as well
const LABEL = 96; // pixels that a name has at least
const BADGE = 11; // pixels; the radius of an open edge's letter
const WIDEST = 1; // m; the radius of what is drawn around an open edge
const CORNER = 6; // pixels; half the side of a zone's corner

/** Draw a grid; soft where its cells are shares of floor and not walls. */
export function drawGrid(context, name, isSoft = false) {
  const layer = grid(name);
  if (!layer) return;
  const [x, y] = layer.origin, size = layer.resolution;
  const [left, top] = toScreen(x, y + layer.rows * size);
  context.imageSmoothingEnabled = isSoft;
  context.drawImage(layer.canvas, left, top, layer.columns * size * view.scale, layer.rows * size * view.scale);
}

/** Draw the ground: what is known, floors, carpets. */
export function drawGround(context) {
  drawGrid(context, "map");
  const home = get("home");
  if (!home) return;
  for (const room of home.rooms) {
    const fill = floorFill(context, room.floor);
    if (!fill) continue;
    traceAll(context, room.rings);
    context.fillStyle = fill;
    context.fill("evenodd");
  }
  for (const carpet of home.carpets ?? []) {
    trace(context, carpet, true);
    context.fillStyle = palette().carpet;
    context.fill();
    context.strokeStyle = palette().carpetEdge;
    context.lineWidth = 1;
    context.stroke();
  }
}

/** Draw what stands on the floor, and what people say about it. */
export function drawThings(context) {
  const home = get("home"), layers = get("layers");
  if (!home) return;
  if (layers.carpets) (home.felt_carpets ?? []).forEach((carpet) => drawCarpet(context, carpet));
  if (layers.furniture) drawFurniture(context, home);
  if (layers.rooms) drawRooms(context, home);
  if (layers.zones) home.zones.forEach((zone) => drawZone(context, get("zone")?.name === zone.name ? chosenZone() : zone));
  (home.changes ?? []).forEach((change) => drawChange(context, change));
  (home.low_things ?? []).forEach((thing) => drawLow(context, thing));
  if (layers.edges) openEdges().forEach((edge, index) => drawEdge(context, edge, index));
  drawStation(context, home);
  if (layers.rooms) home.rooms.forEach((room) => drawName(context, room));
}

function drawFurniture(context, home) {
  const colours = palette();
  context.lineWidth = 1;
  context.shadowColor = colours.shadow;
  context.shadowBlur = 6;
  context.shadowOffsetX = context.shadowOffsetY = 2;
  for (const outline of home.furniture) {
    trace(context, outline, true);
    context.fillStyle = colours.furniture;
    context.fill();
  }
  context.shadowColor = "transparent";
  context.shadowBlur = context.shadowOffsetX = context.shadowOffsetY = 0;
  for (const outline of home.furniture) {
    trace(context, outline, true);
    context.fillStyle = colours.furniture;
    context.fill();
    context.strokeStyle = colours.furnitureEdge;
    context.stroke();
  }
  for (const outline of home.overhead ?? []) {
    trace(context, outline, true);
    context.fillStyle = colours.overhead;
    context.fill();
    context.strokeStyle = colours.overheadEdge;
    context.stroke();
  }
}

function drawRooms(context, home) {
  const colours = palette(), chosen = get("chosen");
  for (const room of home.rooms) {
    const isChosen = chosen.includes(room.name);
    traceAll(context, room.rings);
    if (isChosen) {
      context.fillStyle = colours.chosen;
      context.fill("evenodd");
    } else if (room.floor) continue; // its floor tells where it ends
    trace(context, room.rings.reduce((one, other) => (breadth(other) > breadth(one) ? other : one)), true);
    context.strokeStyle = isChosen ? colours.accent : colours.border;
    context.lineWidth = isChosen ? 2 : 1;
    context.stroke();
  }
}

/** Return how broad a ring is, m: the outer one is the broadest. */
function breadth(ring) {
  const xs = ring.map(([x]) => x);
  return Math.max(...xs) - Math.min(...xs);
}

function drawName(context, room) {
  const colours = palette(), order = get("chosen").indexOf(room.name), [px, py] = toScreen(...room.anchor);
  const tells = view.scale > WIDE;
  const most = Math.max(LABEL, 2 * view.scale * toSide(room));
  write(context, title(room.name), px, py, { isBold: true, size: tells ? 16 : 14, most });
  if (tells) write(context, `${room.area.toFixed(1)} m²`, px, py + 18);
  if (order < 0) return;
  context.beginPath();
  context.arc(px, py - 24, 13, 0, 2 * Math.PI);
  context.fillStyle = colours.accent;
  context.fill();
  context.fillStyle = colours.onAccent;
  context.font = "600 16px system-ui, sans-serif";
  context.fillText(String(order + 1), px, py - 23);
}

/** Return how far the middle of a room's name is from the nearer side of the room, m. */
function toSide({ anchor: [x], rings }) {
  const xs = rings.flat().map(([at]) => at);
  return Math.min(x - Math.min(...xs), Math.max(...xs) - x);
}

function drawZone(context, zone) {
  const colours = palette(), isArea = zone.kind !== "wall", isSelected = get("zone")?.name === zone.name;
  const isCarpet = zone.kind === "carpet", line = isCarpet ? colours.carpetEdge : colours.warn;
  trace(context, zone.points, isArea);
  if (isArea) {
    context.fillStyle = isCarpet ? colours.carpet : colours.warnTint;
    context.fill();
  }
  dashed(context, line, isArea ? 2 : 4, isArea ? [6, 4] : []);
  if (!isSelected) return;
  for (const [x, y] of zone.points) {
    const [px, py] = toScreen(x, y);
    context.fillStyle = colours.paper;
    context.fillRect(px - CORNER, py - CORNER, 2 * CORNER, 2 * CORNER);
    context.strokeStyle = colours.warn;
    context.lineWidth = 2;
    context.strokeRect(px - CORNER, py - CORNER, 2 * CORNER, 2 * CORNER);
  }
}

/** Draw a carpet that was felt as one that is drawn, but without a name. */
function drawCarpet(context, corners) {
  trace(context, corners, true);
  context.fillStyle = palette().carpet;
  context.fill();
  dashed(context, palette().carpetEdge);
}

/** Draw the outline of a thing that appeared, or is gone. */
function drawChange(context, { appeared, x, y, length, width }) {
  const [left, right, low, high] = [x - length / 2, x + length / 2, y - width / 2, y + width / 2];
  trace(context, [[left, low], [right, low], [right, high], [left, high]], true);
  dashed(context, palette().warn);
  write(context, appeared ? "new" : "gone", ...toScreen(x, y), { colour: palette().warn, isBold: true });
}

function drawLow(context, { times, corners }) {
  trace(context, corners, true);
  dashed(context, palette().warn);
  write(context, `felt ${times} times`, ...toScreen(...middleOf(corners)), { colour: palette().warn, isBold: true });
}

/** Draw where the map is open, with the letter by which it is listed: around a short edge as wide as that is long. */
function drawEdge(context, { x, y, length }, index) {
  const colours = palette(), isChosen = get("edge") === index, [px, py] = toScreen(x, y);
  context.beginPath();
  context.arc(px, py, Math.max(BADGE + 4, Math.min(0.5 * length, WIDEST) * view.scale), 0, 2 * Math.PI);
  context.fillStyle = colours.warnTint;
  context.fill();
  dashed(context, colours.warn, isChosen ? 4 : 2);
  context.beginPath();
  context.arc(px, py, BADGE, 0, 2 * Math.PI);
  context.fillStyle = colours.warn;
  context.fill();
  context.fillStyle = colours.paper;
  context.font = "600 14px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(letter(index), px, py + 1);
  if (isChosen) write(context, `open for ${length.toFixed(1)} m`, px, py + BADGE + 14, { colour: colours.warn, isBold: true });
}

/** The middle of a zone around a low thing. */
export function middleOf(corners) {
  return [0, 1].map((axis) => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
}

function drawStation(context, home) {
  const [x, y, theta] = home.station, [px, py] = toScreen(x + 0.15 * Math.cos(theta), y + 0.15 * Math.sin(theta));
  const arm = Math.max(6, 0.1 * view.scale);
  for (const [colour, width] of [[palette().rim, 6], [palette().ink, 3]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(px - arm, py); context.lineTo(px + arm, py);
    context.moveTo(px, py - arm); context.lineTo(px, py + arm);
    context.stroke();
  }
}
