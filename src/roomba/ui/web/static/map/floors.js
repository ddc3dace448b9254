/** Patterns of floors: boards, tiles, stone; drawn once for each look, and laid in metres. */
import { palette } from "./palette.js";
import { toScreen, view } from "./view.js";

const FINENESS = 100; // pixels of a pattern per metre
const BOARD = 0.14, LENGTH = 1.4, ROWS = 6; // m, and how many rows until boards lie alike
const made = new Map();

/** Return what fills a kind of floor as it lies on the screen now, or null for one that is not known. */
export function floorFill(context, kind) {
  const shades = palette().floors[kind];
  if (!shades) return null;
  const key = `${kind} ${shades[0]}`;
  if (!made.has(key)) made.set(key, context.createPattern(kind === "wood" ? boards(shades) : tiles(shades, kind === "tile" ? 0.3 : 0.6), "repeat"));
  const pattern = made.get(key), [left, top] = toScreen(0, 0), share = view.scale / FINENESS;
  pattern.setTransform(new DOMMatrix([share, 0, 0, share, left, top]));
  return pattern;
}

function blank(width, height) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(width * FINENESS);
  canvas.height = Math.round(height * FINENESS);
  return [canvas, canvas.getContext("2d")];
}

function boards([one, other, seam]) {
  const [canvas, context] = blank(2 * LENGTH, ROWS * BOARD);
  for (let row = 0; row < ROWS; row++)
    for (let board = -1; board < 2; board++) {
      const left = (board * LENGTH + ((row * 0.53) % 1) * LENGTH) * FINENESS, top = row * BOARD * FINENESS;
      context.fillStyle = (row * 3 + board + 1) % 2 ? one : other;
      context.fillRect(left, top, LENGTH * FINENESS, BOARD * FINENESS + 1);
      context.fillStyle = seam;
      context.fillRect(left, top, 1, BOARD * FINENESS);
      context.fillRect(left, top, LENGTH * FINENESS, 1);
    }
  return canvas;
}

function tiles([one, other, seam], size) {
  const [canvas, context] = blank(2 * size, 2 * size);
  for (let row = 0; row < 2; row++)
    for (let column = 0; column < 2; column++) {
      context.fillStyle = (row + column) % 2 ? one : other;
      context.fillRect(column * size * FINENESS, row * size * FINENESS, size * FINENESS, size * FINENESS);
      if (one === seam) continue;
      context.fillStyle = seam;
      context.fillRect(column * size * FINENESS, row * size * FINENESS, 2, size * FINENESS);
      context.fillRect(column * size * FINENESS, row * size * FINENESS, size * FINENESS, 2);
    }
  return canvas;
}
