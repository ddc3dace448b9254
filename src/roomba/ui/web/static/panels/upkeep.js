/** Upkeep: hours that parts have left, what is to be done, totals. */
import { $, button, put, span } from "../dom.js";
import { note, wish } from "../link.js";
import { on, get } from "../store.js";
import { duration, title } from "../words.js";
import { askYes } from "./ask.js";

const SOON = 0.1; // share left below which the bar warns
let shown = "";

/** Keep it up to date. */
export function begin() {
  on("state", show);
  $("empty-now").onclick = () => wish("empty_at_station");
  $("bag-replaced").onclick = () => wish("replace_bag");
  $("emptying-when").onchange = () => wish("household/emptying", { when: $("emptying-when").value }, "PUT");
}

function show() {
  const upkeep = get("state")?.upkeep;
  $("upkeep").hidden = !upkeep;
  $("upkeep-due").hidden = !upkeep?.parts.some((part) => part.is_due);
  if (!upkeep) return;
  showBag(upkeep);
  // Ten looks a second come, of which hardly one tells something new.
  const told = JSON.stringify(upkeep);
  if (told === shown) return;
  shown = told;
  const due = upkeep.parts.filter((part) => part.is_due);
  $("upkeep-reminders").replaceChildren(...due.map((part) => item(`${title(part.advice)}.`)));
  put($("upkeep").querySelector("summary"), due.length ? `Upkeep: ${due.length} due` : "Upkeep");
  showParts(upkeep.parts);
  put($("upkeep-totals"), totals(upkeep.totals));
}

/** Show the parts in the elements that there are: a button that is pressed must not be replaced. */
function showParts(parts) {
  const list = $("upkeep-parts");
  if (list.children.length !== parts.length) list.replaceChildren(...parts.map(made));
  parts.forEach((part, index) => {
    const line = list.children[index], meter = line.querySelector("meter");
    line.dataset.due = part.is_due ? "yes" : "no";
    put(line.querySelector(".left"), part.is_due ? "due now" : `${hours(part.left)} left`);
    meter.value = part.share;
    meter.setAttribute("aria-label", `${title(part.name)}: ${hours(part.left)} of ${hours(part.life)} left`);
  });
}

function made(part) {
  const line = document.createElement("li"), about = document.createElement("div"), words = span("line", ""), meter = document.createElement("meter");
  about.className = "part";
  meter.low = SOON;
  meter.optimum = 1;
  words.append(span("name", part.name), span("left", ""));
  about.append(words, meter);
  line.append(about, button("Reset", () => reset(part.name), `Reset the ${part.name}`));
  return line;
}

function showBag(upkeep) {
  $("emptying").hidden = upkeep.bag === null;
  if (upkeep.bag === null) return;
  put($("bag"), upkeep.bag < 1 ? `${Math.round(100 * upkeep.bag)} % full` : "full: put an empty one in");
  const when = get("state").plans?.emptying;
  if (when && document.activeElement !== $("emptying-when")) $("emptying-when").value = when;
}

async function reset(name) {
  const done = name === "sensors" ? "wiped" : name === "bin" ? "emptied" : "replaced";
  const verb = name === "sensors" ? "Were" : "Was";
  if (await askYes(`${verb} the ${name} ${done}?`) && await wish("upkeep/reset", { part: name })) note(`${title(name)}: counted anew.`);
}

function hours(time) { return time < 10 ? `${time.toFixed(1)} h` : `${Math.round(time)} h`; }

function totals(sums) {
  if (!sums.runs) return "No run is kept yet.";
  return `In all ${sums.runs} ${sums.runs === 1 ? "run" : "runs"}, ${sums.covered.toFixed(0)} m², ${duration(sums.duration)}, `
    + `${(sums.distance / 1000).toFixed(2)} km, ${sums.dirt.toFixed(0)} g of dirt, ${sums.energy.toFixed(0)} Wh.`;
}

function item(text) {
  const made = document.createElement("li");
  made.textContent = text;
  return made;
}
