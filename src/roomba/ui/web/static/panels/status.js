/** The state line: headline, explanation, figures, and how the last run ended. */
import { $, put } from "../dom.js";
import { get, on } from "../store.js";
import { explanation, headline, lastRun } from "../words.js";

/** Keep it up to date. */
export function begin() {
  on("state link age reason", show);
}

function show() {
  const link = get("link"), state = get("state");
  const told = explanation(link, state, get("reason"), get("age"));
  put($("headline"), headline(link, state));
  put($("explanation"), told);
  document.body.dataset.link = link;
  document.body.dataset.attention = told ? "yes" : "no";
  document.body.dataset.held = state?.held ? "yes" : "no";
  if (!state) return;
  const { vacuum } = state;
  document.body.dataset.phase = vacuum.phase;
  put($("battery"), vacuum.battery === null ? "–" : `${Math.floor(100 * vacuum.battery)} %`);
  put($("covered"), vacuum.wanted ? `${vacuum.covered.toFixed(1)} of ${vacuum.wanted.toFixed(1)} m²` : "–");
  put($("dirt"), `${state.dirt.toFixed(1)} g`);
  $("last").hidden = !state.last;
  if (state.last) showLast(state.last);
}

function showLast(report) {
  const text = lastRun(report);
  if ($("last-text").textContent === text) return;
  $("last-text").textContent = text;
  $("last-missed").replaceChildren(...report.missed.map((miss) => {
    const item = document.createElement("li");
    item.textContent = `${miss.area.toFixed(2)} m² missed${miss.room ? ` in ${miss.room}` : ""}: ${miss.reason}`;
    return item;
  }));
}
