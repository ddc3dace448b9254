/** Where the floor lies on the screen: metres to pixels and back, pan and zoom. */

export const view = { x: 0, y: 0, scale: 60, width: 1, height: 1, isFitted: false };

const LEAST = 8, MOST = 600; // pixels per metre

/** Return pixels of a place, m. */
export function toScreen(x, y) {
  return [view.width / 2 + (x - view.x) * view.scale, view.height / 2 - (y - view.y) * view.scale];
}

/** Return the place of pixels, m. */
export function toFloor(px, py) {
  return [view.x + (px - view.width / 2) / view.scale, view.y - (py - view.height / 2) / view.scale];
}

/** Move what is seen by pixels. */
export function pan(dx, dy) {
  view.x -= dx / view.scale;
  view.y += dy / view.scale;
  view.isFitted = true;
}

/** Zoom around pixels, which stay where they are. */
export function zoom(factor, px = view.width / 2, py = view.height / 2) {
  const [x, y] = toFloor(px, py);
  view.scale = Math.min(MOST, Math.max(LEAST, view.scale * factor));
  const [nowX, nowY] = toFloor(px, py);
  view.x += x - nowX;
  view.y += y - nowY;
  view.isFitted = true;
}

/** Show a box of the floor as large as it goes: lowest x and y, highest x and y, m. */
export function fit([left, bottom, right, top]) {
  view.x = (left + right) / 2;
  view.y = (bottom + top) / 2;
  view.scale = Math.min(MOST, Math.max(LEAST,
    Math.min(view.width / (right - left), view.height / (top - bottom)) * 0.92));
}
