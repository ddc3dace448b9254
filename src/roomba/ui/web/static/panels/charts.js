/** Live charts of the last minutes: battery, rate of dirt, speed; in a wide window the rate of dirt also under the map. */
import { chart } from "../chart.js";
import { $, put } from "../dom.js";
import { get, on } from "../store.js";
import { duration } from "../words.js";

const KEPT = 600, STEP = 1; // s of the robot's clock that are shown, and between two points
const NO_BATTERY = "Battery: not known";
const WINDOW = 20; // s over which the rate of dirt is the mean

let points = []; // [time, battery in % (null: not known), g in its bin (null: not known), g that were picked up so far, speed]

/** Follow the robot, whether the charts are seen or not. */
export function begin() {
  on("state", follow);
  $("charts").ontoggle = show;
}

function follow() {
  const state = get("state");
  if (!state) return;
  const last = points.at(-1);
  if (last && (state.time < last.time || state.time - last.time > KEPT)) points = [];
  const before = points.at(-1);
  if (before && state.time - before.time < STEP) return;
  const taken = before ? before.taken + more(before.dirt, state.dirt) : 0;
  points.push({ time: state.time, battery: percent(state.vacuum.battery), dirt: state.dirt, taken, speed: state.speed });
  while (points[0].time < state.time - KEPT) points.shift();
  show();
}

function percent(share) { return share === null ? null : 100 * share; }

function more(before, now) { return before === null || now === null ? 0 : Math.max(0, now - before); }

function show() {
  const isUnderMap = $("rate").getClientRects().length > 0;
  if (!points.length || !($("charts").open || isUnderMap)) return;
  const now = points.at(-1), rates = points.map((point) => [point.time, rate(point)]);
  const dirt = now.dirt === null ? "Dirt: not known" : `Dirt ${rates.at(-1)[1].toFixed(2)} g/min`;
  if (isUnderMap) line($("rate-line"), $("rate-title"), rates, dirt);
  if (!$("charts").open) return;
  const batteries = points.filter(({ battery }) => battery !== null).map(({ time, battery }) => [time, battery]);
  if (batteries.length) chartOf("battery", batteries, now.battery === null ? NO_BATTERY : `Battery ${now.battery.toFixed(0)} %`, 100);
  else { put($("chart-battery-title"), NO_BATTERY); $("chart-battery").replaceChildren(); }
  chartOf("rate", rates, dirt);
  chartOf("speed", points.map(({ time, speed }) => [time, speed]), `Speed ${now.speed.toFixed(2)} m/s`);
}

function rate(point) {
  const from = points.find(({ time }) => time >= point.time - WINDOW);
  return point.time > from.time ? 60 * (point.taken - from.taken) / (point.time - from.time) : 0;
}

function chartOf(name, ...what) { line($(`chart-${name}`), $(`chart-${name}-title`), ...what); }

function line(svg, above, values, title, highest) {
  put(above, title);
  const ago = `${duration(values.at(-1)[0] - values[0][0])} ago`;
  chart(svg, values, `${title}, the last ten minutes`, [ago, "now"], highest);
}
