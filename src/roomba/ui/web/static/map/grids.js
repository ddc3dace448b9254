/** Grids that are drawn over the floor: a canvas each, of which only changed tiles are redrawn. */

import { palette } from "./palette.js";

const grids = new Map();
const versions = new Map(); // how often each grid has changed

/** How often a grid has changed. */
export function version(name) { return versions.get(name) ?? 0; }

/** Take a message of tiles: header's length, header, cells (see tiles.py). */
export function takeTiles(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let grid = grids.get(header.layer);
  if (!grid || header.whole) {
    const canvas = document.createElement("canvas");
    canvas.width = header.columns;
    canvas.height = header.rows;
    grid = { canvas, cells: new Uint8Array(header.rows * header.columns) };
    grids.set(header.layer, grid);
  }
  Object.assign(grid, {
    rows: header.rows, columns: header.columns, resolution: header.resolution, origin: header.origin,
  });
  let at = 4 + length;
  for (const [row, column, height, width] of header.tiles) {
    for (let line = 0; line < height; line++, at += width)
      grid.cells.set(new Uint8Array(buffer, at, width), (row + line) * grid.columns + column);
    paint(header.layer, grid, row, column, height, width);
  }
  versions.set(header.layer, version(header.layer) + 1);
}

/** Forget all grids. */
export function forgetGrids() {
  for (const name of grids.keys()) versions.set(name, version(name) + 1);
  grids.clear();
}

/** Draw all cells anew, as for other colours. */
export function repaint() {
  for (const [name, grid] of grids) {
    paint(name, grid, 0, 0, grid.rows, grid.columns);
    versions.set(name, version(name) + 1);
  }
}

/** Return a grid by its name, or nothing. */
export function grid(name) { return grids.get(name); }

/** Whether a place, m, lies on the map: floor, wall or furniture. */
export function isKnown(x, y) {
  const map = grids.get("map");
  if (!map) return false;
  const row = Math.floor((y - map.origin[1]) / map.resolution), column = Math.floor((x - map.origin[0]) / map.resolution);
  return row >= 0 && row < map.rows && column >= 0 && column < map.columns && map.cells[row * map.columns + column] > 0;
}

/** Return what colours the cells of a grid, as red, green, blue and opacity. */
function colours(name) {
  const { free, wall, furniture, swept, sweptAlpha, dirt } = palette().cells, none = [0, 0, 0, 0];
  if (name === "map") {
    const looks = [none, [...free, 255], [...wall, 255], [...furniture, 255]];
    return (value) => looks[value];
  }
  if (name === "coverage") {
    const looks = [none, ...swept.map((colour) => [...colour, sweptAlpha])];
    return (value) => looks[Math.min(value, 3)];
  }
  return (value) => [...dirt, Math.min(210, value)];
}

function paint(name, grid, row, column, height, width) {
  const context = grid.canvas.getContext("2d");
  const image = context.createImageData(width, height);
  const colour = colours(name), { data } = image;
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const value = grid.cells[(row + y) * grid.columns + column + x];
      data.set(colour(value), 4 * ((height - 1 - y) * width + x)); // row 0 is the lowest
    }
  context.putImageData(image, column, grid.rows - row - height);
}
