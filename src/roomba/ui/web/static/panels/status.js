/** The state line: headline, explanation, figures, progress, and how the last run ended. */
import { $, put, span } from "../dom.js";
import { get, on } from "../store.js";
import { duration, explanation, headline, lastRun, oldness, shortfall, title, toGo } from "../words.js";

const WORKS = ["cleaning", "undocking", "returning", "docking", "exploring"];
const BETWEEN = ["docked", "idle", "returning", "docking"]; // what it does between two runs, when no floor is wanted

/** Keep it up to date. */
export function begin() {
  on("state link age reason", show);
}

function show() {
  const link = get("link"), state = get("state"), { body } = document;
  const told = explanation(link, state, get("reason"), get("seenAt")) || (isBetweenRuns(state) ? shortfall(state.last) : "");
  put($("headline"), headline(link, state));
  put($("to-go"), toGo(link, state));
  put($("explanation"), told);
  put($("old"), oldness(link, get("age")));
  body.dataset.link = link;
  body.dataset.attention = told ? "yes" : "no";
  body.dataset.held = state?.held ? "yes" : "no";
  if (!state) return;
  const { vacuum } = state;
  body.dataset.phase = vacuum.phase;
  body.dataset.works = WORKS.includes(vacuum.phase) ? "yes" : "no";
  figure("battery", vacuum.battery === null ? "–" : `${Math.floor(100 * vacuum.battery)} %`, batteryTime(vacuum));
  const share = vacuum.wanted ? Math.floor(100 * vacuum.fraction) : null;
  figure("covered", share === null ? "–" : `${share} %`, share === null ? "" : `${vacuum.covered.toFixed(1)} of ${vacuum.wanted.toFixed(1)} m²`);
  figure("dirt", state.dirt === null ? "–" : `${state.dirt.toFixed(1)} g`);
  $("progress").hidden = share === null;
  $("progress").setAttribute("aria-valuenow", String(share ?? 0));
  $("progress").firstElementChild.style.width = `${share ?? 0}%`;
  $("last").hidden = !state.last;
  if (state.last) showLast(state.last);
}

function isBetweenRuns(state) { return Boolean(state) && !state.vacuum.wanted && BETWEEN.includes(state.vacuum.phase); }

function batteryTime({ battery_seconds: seconds, charges }) {
  if (seconds === null || seconds === undefined) return "";
  return charges ? `full in ${duration(seconds)}` : duration(seconds);
}

function figure(id, text, beside = "") {
  const key = `${text}|${beside}`;
  if ($(id).dataset.shown === key) return;
  $(id).dataset.shown = key;
  const small = document.createElement("small");
  small.textContent = beside ? ` ${beside}` : "";
  $(id).replaceChildren(span("number", text), small);
}

function showLast(report) {
  const text = lastRun(report);
  if ($("last-text").textContent === text) return;
  $("last-text").textContent = text;
  $("last-times").hidden = !report.times.length || !report.times_least;
  $("last-least").textContent = report.times_least ? `${report.times_least.toFixed(2)} times the least time for that floor` : "";
  $("last-parts").replaceChildren(...report.times.map(([what, seconds]) => {
    const item = document.createElement("li");
    item.textContent = `${title(what)}: ${duration(seconds)}`;
    return item;
  }));
  $("last-missed").replaceChildren(...report.missed.map((miss) => {
    const item = document.createElement("li");
    item.textContent = `${miss.area.toFixed(2)} m² missed${miss.room ? ` in ${miss.room}` : ""}: ${miss.reason}`;
    return item;
  }));
}
