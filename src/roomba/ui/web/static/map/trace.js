/** What is common to all that is drawn on the map. */
import { palette } from "./palette.js";
import { toScreen } from "./view.js";

/** Begin a path along points, m. */
export function trace(context, points, isClosed) {
  context.beginPath();
  along(context, points, isClosed);
}

/** Go on with a path along rings, m: holes stay holes with the even-odd rule. */
export function traceAll(context, rings) {
  context.beginPath();
  for (const ring of rings) along(context, ring, true);
}

function along(context, points, isClosed) {
  points.forEach(([x, y], index) => {
    const [px, py] = toScreen(x, y);
    if (index) context.lineTo(px, py); else context.moveTo(px, py);
  });
  if (isClosed) context.closePath();
}

/** Draw a dashed line over the present path. */
export function dashed(context, colour, width = 2, dashes = [6, 4]) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dashes);
  context.stroke();
  context.setLineDash([]);
}

/** Write a text with a halo, its middle at pixels; one that is wider than `most` pixels ends in an ellipsis. */
export function write(context, text, px, py, { colour = palette().ink, size = 14, isBold = false, most = Infinity } = {}) {
  context.font = `${isBold ? "600 " : ""}${size}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 4;
  context.strokeStyle = palette().halo;
  const shown = clipped(context, text, most);
  context.strokeText(shown, px, py);
  context.fillStyle = colour;
  context.fillText(shown, px, py);
}

function clipped(context, text, most) {
  let shown = text;
  for (let end = text.length; end > 0 && context.measureText(shown).width > most; end--) shown = `${text.slice(0, end).trimEnd()}…`;
  return shown;
}
