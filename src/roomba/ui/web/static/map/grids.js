/** Grids that are drawn over the floor: a canvas each, of which only changed tiles are redrawn. */

const grids = new Map();
let shown = 0; // grows when something changed

/** How often any grid has changed. */
export function version() { return shown; }

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
  shown++;
}

/** Draw all cells anew, as for other colours. */
export function repaint() {
  for (const [name, grid] of grids) paint(name, grid, 0, 0, grid.rows, grid.columns);
  shown++;
}

/** Return a grid by its name, or nothing. */
export function grid(name) { return grids.get(name); }

const dark = matchMedia("(prefers-color-scheme: dark)");
dark.addEventListener("change", repaint);

function colours(name) {
  const night = dark.matches;
  if (name === "map")
    return (value) => value === 1 ? (night ? [46, 48, 53, 255] : [252, 250, 245, 255])
      : value === 2 ? (night ? [168, 160, 148, 255] : [112, 104, 94, 255]) : [0, 0, 0, 0];
  if (name === "coverage")
    return (value) => value === 0 ? [0, 0, 0, 0] : night
      ? [[0, 0, 0, 0], [38, 105, 82, 235], [30, 140, 103, 235], [32, 176, 128, 235]][value]
      : [[0, 0, 0, 0], [199, 231, 217, 235], [146, 207, 181, 235], [92, 178, 143, 235]][value];
  return (value) => value === 0 ? [0, 0, 0, 0] : [190, 110, 20, Math.min(210, value)];
}

function paint(name, grid, row, column, height, width) {
  const context = grid.canvas.getContext("2d");
  const image = context.createImageData(width, height);
  const colour = colours(name);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const value = grid.cells[(row + y) * grid.columns + column + x];
      image.data.set(colour(value), 4 * ((height - 1 - y) * width + x)); // row 0 is the lowest
    }
  context.putImageData(image, column, grid.rows - row - height);
}
