/** Draws what changes all the time: robot, way, path, lidar, the truth, and what the viewer draws. */
import { get } from "../store.js";
import { palette } from "./palette.js";
import { dashed, trace } from "./trace.js";
import { toScreen, view } from "./view.js";

const UNSEEN = 1; // m between two places, of which the way is not known
const SOON = 4; // m of the way to go that are drawn strongly
const PIECES = 12; // of the way, each fainter than the newer one

/** Draw the way so far: thin, and fainter the older it is. */
export function drawTrail(context) {
  const points = get("trail"), newest = points.length;
  context.lineWidth = 1.25;
  context.lineJoin = "round";
  for (let piece = 0; piece < PIECES; piece++) {
    const begins = Math.max(0, Math.floor(newest * piece / PIECES) - 1), ends = Math.floor(newest * (piece + 1) / PIECES);
    if (ends - begins < 2) continue;
    traceWay(context, points, begins, ends);
    context.strokeStyle = `rgb(${palette().trail} / ${(0.08 + 0.62 * ((piece + 1) / PIECES) ** 2).toFixed(2)})`;
    context.stroke();
  }
}

/** Begin a path along some of the places, [x, y, whether it was carried there]: what was not driven, or not seen, is left out. */
function traceWay(context, points, begins, ends) {
  context.beginPath();
  for (let index = begins; index < ends; index++) {
    const [x, y, isCarried] = points[index], before = points[index - 1], [px, py] = toScreen(x, y);
    if (index > begins && !isCarried && Math.hypot(x - before[0], y - before[1]) < UNSEEN) context.lineTo(px, py); else context.moveTo(px, py);
  }
}

/** Draw the state: path, lidar, robot and, where it is told, the truth. */
export function drawState(context, state, pose, home) {
  const layers = get("layers");
  if (layers.path && state.path.length >= 4) {
    drawPath(context, pairs(state.path));
  }
  if (layers.scan) drawScan(context, state.scan);
  if (layers.truth && state.truth) drawTruth(context, state.truth, home);
  if (home) drawRobot(context, pose, home.radius);
  const carried = get("carried");
  if (carried && home) {
    context.globalAlpha = 0.6;
    drawRobot(context, [carried[0], carried[1], pose[2]], 1.15 * home.radius);
    context.globalAlpha = 1;
  }
}

/** Draw the way to go: dotted what comes soon, and a hint of the rest. */
function drawPath(context, points) {
  let end = 1;
  for (let length = 0; end < points.length && length < SOON; end++) length += Math.hypot(points[end][0] - points[end - 1][0], points[end][1] - points[end - 1][1]);
  context.globalAlpha = 0.3;
  trace(context, points.slice(end - 1), false);
  dashed(context, palette().path, 1.25, []);
  context.globalAlpha = 1;
  trace(context, points.slice(0, end), false);
  dashed(context, palette().path, 2, [2, 5]);
}

function pairs(flat) {
  const points = [];
  for (let index = 0; index < flat.length; index += 2) points.push([flat[index] / 100, flat[index + 1] / 100]);
  return points;
}

function drawScan(context, flat) {
  context.fillStyle = palette().scan;
  for (const [x, y] of pairs(flat)) {
    const [px, py] = toScreen(x, y);
    context.fillRect(px - 1, py - 1, 2.5, 2.5);
  }
}

function drawTruth(context, truth, home) {
  const colours = palette();
  for (const outline of truth.things) {
    trace(context, outline, true);
    context.fillStyle = colours.truthTint;
    context.fill();
    context.strokeStyle = colours.truth;
    context.lineWidth = 1.5;
    context.stroke();
  }
  for (const { opening: [left, low, right, high], is_shut: isShut } of truth.doors) {
    trace(context, [[left, low], [right, low], [right, high], [left, high]], true);
    if (isShut) {
      context.fillStyle = colours.truth;
      context.fill();
    }
    dashed(context, colours.truth, 1.5, isShut ? [] : [3, 3]);
  }
  if (!home) return;
  const [x, y, theta] = truth.pose, [px, py] = toScreen(x, y), size = Math.max(7, home.radius * view.scale) + 3;
  context.beginPath();
  context.arc(px, py, size, 0, 2 * Math.PI);
  context.moveTo(px, py);
  context.lineTo(px + 1.4 * size * Math.cos(theta), py - 1.4 * size * Math.sin(theta));
  dashed(context, colours.truth, 2, [4, 3]);
}

function drawRobot(context, [x, y, theta], radius) {
  const colours = palette(), [px, py] = toScreen(x, y), size = Math.max(8, radius * view.scale);
  context.beginPath();
  context.arc(px, py, size, 0, 2 * Math.PI);
  context.fillStyle = colours.body;
  context.fill();
  context.lineWidth = 2;
  context.strokeStyle = colours.rim;
  context.stroke();
  context.beginPath();
  context.arc(px, py, size * 0.74, -theta - 1, -theta + 1);
  context.strokeStyle = colours.nose;
  context.lineWidth = Math.max(2.5, size * 0.2);
  context.lineCap = "round";
  context.stroke();
  context.lineCap = "butt";
  context.beginPath();
  context.arc(px, py, size * 0.2, 0, 2 * Math.PI);
  context.fillStyle = colours.dot;
  context.fill();
}

/** Draw what the viewer draws. */
export function drawDraft(context) {
  const drawing = get("drawing");
  if (!drawing?.from || !drawing.to) return;
  const [[x, y], [toX, toY]] = [drawing.from, drawing.to], colours = palette();
  const isLine = drawing.kind === "wall" || drawing.kind === "split";
  trace(context, isLine ? [[x, y], [toX, toY]] : [[x, y], [toX, y], [toX, toY], [x, toY]], !isLine);
  const isKind = drawing.kind === "no-go" || drawing.kind === "wall";
  if (!isLine) {
    context.fillStyle = isKind ? colours.warnTint : colours.chosen;
    context.fill();
  }
  dashed(context, isKind ? colours.warn : colours.accent, isLine ? 3 : 2);
}
