/** Where the floor lies on the screen: metres to pixels and back, pan and zoom. */

export const view = { x: 0, y: 0, scale: 60, width: 1, height: 1, isFitted: false };

const LEAST = 8, MOST = 600; // pixels per metre
const SIDE = 24, BELOW = 64; // pixels that stay free around the home; the tools lie below

let box = null; // lowest x and y, highest x and y of what is known, m

/** Return pixels of a place, m. */
export function toScreen(x, y) {
  return [view.width / 2 + (x - view.x) * view.scale, view.height / 2 - (y - view.y) * view.scale];
}

/** Return the place of pixels, m. */
export function toFloor(px, py) {
  return [view.x + (px - view.width / 2) / view.scale, view.y - (py - view.height / 2) / view.scale];
}

/** Move what is seen by pixels; the middle stays over the home. */
export function pan(dx, dy) {
  const [left, bottom, right, top] = box ?? [-Infinity, -Infinity, Infinity, Infinity];
  view.x = between(view.x - dx / view.scale, Math.min(left, view.x), Math.max(right, view.x));
  view.y = between(view.y + dy / view.scale, Math.min(bottom, view.y), Math.max(top, view.y));
  view.isFitted = true;
}

/** Bring a place, m, into the middle. */
export function centre(x, y) { pan((view.x - x) * view.scale, (y - view.y) * view.scale); }

/** Zoom around pixels, which stay where they are. */
export function zoom(factor, px = view.width / 2, py = view.height / 2) {
  const [x, y] = toFloor(px, py);
  view.scale = Math.min(MOST, Math.max(LEAST, view.scale * factor));
  const [nowX, nowY] = toFloor(px, py);
  view.x += x - nowX;
  view.y += y - nowY;
  view.isFitted = true;
}

/** Tell what is known of the floor: lowest x and y, highest x and y, m. */
export function bound(known) { box = known; }

/** Show all that is known as large as it goes. */
export function fit() {
  if (!box) return;
  const [left, bottom, right, top] = box, width = view.width - 2 * SIDE, height = view.height - SIDE - BELOW;
  view.scale = Math.min(MOST, Math.max(LEAST, Math.min(width / (right - left), height / (top - bottom))));
  view.x = (left + right) / 2;
  view.y = (bottom + top) / 2 - (BELOW - SIDE) / 2 / view.scale;
}

function between(value, least, most) { return Math.max(least, Math.min(value, most)); }
