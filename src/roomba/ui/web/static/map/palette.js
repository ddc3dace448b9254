/** The colours of the map, by day and by night: warm greys, wood and tiles, greens for what is clean; orange (`warn`) is for what wants attention alone. */

const night = matchMedia("(prefers-color-scheme: dark)");

const DAY = {
  paper: "#f4f1eb", ink: "#2b2e33", halo: "rgb(255 255 255 / 85%)", accent: "#00694c", onAccent: "#ffffff", chosen: "rgb(0 105 76 / 16%)",
  warn: "#a84300", warnTint: "rgb(168 67 0 / 15%)", truth: "#71389c", truthTint: "rgb(113 56 156 / 18%)",
  border: "rgb(43 46 51 / 18%)", trail: "43 46 51", path: "rgb(0 96 168 / 50%)", scan: "#9c1060", shadow: "rgb(60 48 40 / 34%)",
  furniture: "#ddd4c6", furnitureEdge: "#a79c8a", overhead: "rgb(221 212 198 / 45%)", overheadEdge: "rgb(130 119 102 / 45%)",
  carpet: "rgb(120 112 104 / 16%)", carpetEdge: "rgb(120 112 104 / 30%)",
  body: "#2c2e34", rim: "#ffffff", nose: "#48cc80", dot: "#d9dbe0",
  cells: { free: [251, 249, 244], wall: [84, 78, 70], furniture: [221, 212, 198], swept: [[176, 219, 190], [118, 190, 148], [66, 154, 110]], sweptAlpha: 205, dirt: [122, 84, 40] },
  floors: { wood: ["#efdfc6", "#e9d7bb", "#dcc7a6"], tile: ["#e8ebeb", "#eef0ef", "#d4d9d9"], stone: ["#e8e4dc", "#edeae3", "#d8d3c8"], fabric: ["#ebe4da", "#ebe4da", "#ebe4da"] },
};
const NIGHT = {
  paper: "#1a1c1f", ink: "#f2f0ec", halo: "rgb(20 22 24 / 88%)", accent: "#4fd0a3", onAccent: "#10241c", chosen: "rgb(79 208 163 / 22%)",
  warn: "#ffb066", warnTint: "rgb(255 176 102 / 20%)", truth: "#d2a8ff", truthTint: "rgb(210 168 255 / 22%)",
  border: "rgb(236 234 230 / 18%)", trail: "242 240 236", path: "rgb(124 196 255 / 55%)", scan: "#ff8ac8", shadow: "rgb(0 0 0 / 45%)",
  furniture: "#58544d", furnitureEdge: "#7d776c", overhead: "rgb(88 84 77 / 50%)", overheadEdge: "rgb(140 133 120 / 50%)",
  carpet: "rgb(200 196 190 / 10%)", carpetEdge: "rgb(200 196 190 / 20%)",
  body: "#eceae6", rim: "#1a1c1f", nose: "#0b8f5a", dot: "#55585e",
  cells: { free: [46, 46, 48], wall: [150, 142, 130], furniture: [88, 84, 77], swept: [[36, 98, 74], [31, 130, 94], [38, 168, 120]], sweptAlpha: 215, dirt: [186, 158, 124] },
  floors: { wood: ["#403831", "#443b33", "#342e28"], tile: ["#383b3d", "#3b3e40", "#2e3032"], stone: ["#3d3b37", "#403e3a", "#32302d"], fabric: ["#403b36", "#403b36", "#403b36"] },
};

/** Return the colours of now. */
export function palette() { return night.matches ? NIGHT : DAY; }

/** Call a function when the colours change. */
export function onColours(listener) { night.addEventListener("change", listener); }
