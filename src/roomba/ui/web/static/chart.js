/** A line over time, as SVG. */

const SPACE = "http://www.w3.org/2000/svg";
const LEFT = 40, TOP = 8, BOTTOM = 20; // px

const drawn = new WeakMap(); // what each picture shows
const resized = new ResizeObserver((entries) => entries.forEach(({ target }) => draw(target, ...drawn.get(target))));

/** Draw `points`, [time, value], from 0 to `highest` (by default the highest value); say what it is, and when it `begins` and `ends`. */
export function chart(svg, ...what) {
  drawn.set(svg, what);
  resized.observe(svg);
  draw(svg, ...what);
}

function draw(svg, points, title, [begins, ends], highest) {
  const { width, height } = svg.getBoundingClientRect();
  if (!width) return; // it is not seen yet
  const top = highest ?? niceAbove(Math.max(...points.map(([, value]) => value), 0));
  const [first, last] = [points[0]?.[0] ?? 0, points.at(-1)?.[0] ?? 1], span = Math.max(last - first, 1e-9);
  const base = height - BOTTOM;
  const place = ([time, value]) => [
    LEFT + (width - LEFT - 4) * (time - first) / span,
    TOP + (base - TOP) * (1 - Math.min(1, value / top)),
  ].map((one) => one.toFixed(1)).join(",");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", title);
  const marks = points.length <= 40 ? points.map((point) => {
    const [x, y] = place(point).split(",");
    return part("circle", { class: "mark", cx: x, cy: y, r: 2.5 });
  }) : [];
  svg.replaceChildren(
    part("path", { class: "axis", d: `M${LEFT} ${TOP}V${base}H${width - 4}` }),
    part("text", { x: LEFT - 4, y: TOP + 10 }, String(top)),
    part("text", { x: LEFT - 4, y: base }, "0"),
    part("text", { x: LEFT, y: height - 4, class: "begins" }, begins),
    part("text", { x: width - 4, y: height - 4 }, ends),
    part("polyline", { class: "line", points: points.map(place).join(" ") }),
    ...marks,
  );
}

/** Return a round number that is not below a value. */
function niceAbove(value) {
  if (value <= 0) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return Number((power * [1, 2, 5, 10].find((step) => step * power >= value)).toPrecision(2));
}

function part(name, attributes, text = "") {
  const element = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return element;
}
