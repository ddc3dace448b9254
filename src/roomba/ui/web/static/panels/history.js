/** The history: every run with its report, two compared, each replayed, totals by week, the home's dirt. */
import { chart } from "../chart.js";
import { $, offer } from "../dom.js";
import { BASE, ask } from "../link.js";
import { get, on } from "../store.js";
import { duration, title } from "../words.js";
import { closed, opened, remember, wasShown } from "./opened.js";

let runs = [], compared = [];

/** Connect the buttons. */
export function begin() {
  $("history-open").onclick = open;
  $("history-close").onclick = close;
  $("history-home").onchange = showDirt;
  $("history-older").onclick = showOlder;
  $("history-compare").onclick = () => {
    const [one, other] = [...compared].sort((a, b) => a - b);
    window.open(`${BASE}api/v1/history/compare.html?one=${one}&other=${other}`, "_blank", "noopener");
  };
  let isBack = wasShown("history"); // the browser came back to it from elsewhere
  on("hasHistory", () => {
    $("history-open").hidden = !get("hasHistory");
    if (!get("hasHistory") || !isBack) return;
    isBack = false;
    open();
  });
}

async function open() {
  const told = await ask("history");
  if (!told) return;
  runs = [];
  compared = [];
  $("history-runs").replaceChildren();
  $("history-weeks").replaceChildren(...told.weeks.map(week));
  $("history").hidden = false;
  for (const part of document.querySelectorAll("main > :not(#history)")) part.inert = true;
  opened("history", close);
  remember("history", true);
  $("history-title").focus();
  take(told, told.runs[0]?.home);
}

/** Show runs that are older than those that are shown; the first of them gets the focus. */
async function showOlder() {
  const oldest = runs.at(-1).number;
  $("history-older").disabled = true;
  const told = await ask(`history?before=${oldest}`);
  $("history-older").disabled = false;
  if (!told || runs.at(-1)?.number !== oldest) return; // it was opened anew meanwhile
  take(told, $("history-home").value);
  document.querySelector(`#history-runs [aria-label="${labelOf(told.runs[0])}"]`)?.focus();
}

/** Show runs after those that are shown, and the dirt of a home. */
function take(told, home) {
  runs = [...runs, ...told.runs];
  $("history-runs").append(...told.runs.map(row));
  $("history-older").parentElement.hidden = !told.has_older;
  $("history").toggleAttribute("data-empty", runs.length === 0);
  offer($("history-home"), [...new Set(runs.map((run) => run.home))].map((name) => [name, name]), home);
  showDirt();
  showCompared();
}

function close() {
  $("history").hidden = true;
  closed("history");
  remember("history", false);
  for (const part of document.querySelectorAll("main > *")) part.inert = false;
  $("history-open").focus();
}

function showDirt() {
  const home = $("history-home").value, cleans = runs.filter((run) => run.home === home && run.kind === "clean" && run.dirt !== null);
  $("history-few").hidden = cleans.length > 1;
  $("history-dirt").toggleAttribute("hidden", cleans.length < 2);
  const points = cleans.map((run) => [run.began, run.dirt]).reverse(), days = [points[0], points.at(-1)].map((point) => (point ? day(point[0]) : ""));
  chart($("history-dirt"), points, `Dirt of ${home}: g that each of ${cleans.length} cleans picked up`, days);
}

function showCompared() {
  $("history-compare").disabled = compared.length !== 2;
  for (const box of document.querySelectorAll("#history-runs input"))
    box.disabled = compared.length === 2 && !box.checked;
}

function row(run) {
  const line = document.createElement("tr"), box = document.createElement("input");
  box.type = "checkbox";
  box.setAttribute("aria-label", labelOf(run));
  box.onchange = () => {
    compared = box.checked ? [...compared, run.number] : compared.filter((one) => one !== run.number);
    showCompared();
  };
  const links = document.createElement("span");
  links.className = "links";
  links.append(link("Report", `${BASE}api/v1/history/${run.number}/report.html`, `Report of run ${run.number}`, true));
  if (run.is_recorded) links.append(link("Replay", `${BASE}replay/${run.number}/`, `Replay run ${run.number}`, false));
  const share = run.fraction === null ? "–" : `${(100 * run.fraction).toFixed(1)} %`;
  const cells = [box, run.number, new Date(1000 * run.began).toLocaleString([], { dateStyle: "short", timeStyle: "short" }),
    run.home, title(run.outcome), share, places(run.missed), known(run.duration, duration),
    known(run.kind === "clean" ? run.rate : null, (rate) => rate.toFixed(2)), known(run.dirt, (dirt) => `${dirt.toFixed(1)} g`), links];
  return filled(line, cells);
}

function labelOf(run) { return `Compare run ${run.number}`; }

function week(totals) {
  const line = document.createElement("tr");
  return filled(line, [totals.week, totals.runs, `${totals.covered.toFixed(1)} m²`, duration(totals.duration),
    `${totals.distance.toFixed(0)} m`, `${totals.dirt.toFixed(1)} g`, `${totals.energy.toFixed(1)} Wh`], "#history-week-heads");
}

function day(seconds) { return new Date(1000 * seconds).toLocaleDateString([], { dateStyle: "short" }); }

function places(count) { return count ? `${count} ${count === 1 ? "place" : "places"}` : "nothing"; }

function known(value, say) { return value === null ? "–" : say(value); }

/** Fill a line of a table; on a phone each cell tells its heading itself. */
function filled(line, cells, heads = "#history-run-heads") {
  const names = [...document.querySelectorAll(`${heads} th`)].map((head) => head.textContent);
  line.setAttribute("role", "row");
  line.append(...cells.map((content, index) => {
    const place = document.createElement("td");
    place.setAttribute("role", "cell");
    place.dataset.head = names[index];
    place.append(content);
    return place;
  }));
  return line;
}

function link(text, address, label, isOutside) {
  const anchor = document.createElement("a");
  anchor.textContent = text;
  anchor.href = address;
  anchor.setAttribute("aria-label", label);
  if (isOutside) Object.assign(anchor, { target: "_blank", rel: "noopener" });
  return anchor;
}
