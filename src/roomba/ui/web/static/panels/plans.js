/** Plans: what comes next, what waits and why; plans, presets, quiet hours, people. */
import { $, button, put, replaceLines, span } from "../dom.js";
import { ask, askFor, note, wish } from "../link.js";
import { get, mayMove, on } from "../store.js";
import { sentence, title } from "../words.js";
import { mayEnd } from "./actions.js";
import { askName, askYes } from "./ask.js";
import { askPlan, daysInWords } from "./plan_form.js";

const MOST_NOTES = 12;
const EMPTY = { mode: "whole", rooms: [], passes: 1, fan: "standard", carpets: "boost", edges: "any" };
const QUIET_DAYS = { all: [0, 1, 2, 3, 4, 5, 6], work: [0, 1, 2, 3, 4], rest: [5, 6] };
const ONLY_NEW = { "If-None-Match": "*" }; // to be added, and to replace none
const WEEK = ["Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"];

let told = null; // what the server told last
let asked = 0; // the version that was asked for last
let changes = 0; // grows when a change begins, and when it is answered: what was asked for before is old

/** Connect the buttons, and keep it up to date. */
export function begin() {
  $("plan-new").onclick = () => edit("New plan", { name: "", is_on: true, begins: today(), rule: "FREQ=DAILY", at: ["09:00"], order: EMPTY }, true);
  $("preset-new").onclick = () => edit("New preset", { name: "", order: EMPTY }, false);
  $("quiet-add").onclick = async () => await known() && quiet([...told.quiet, { begins: $("quiet-begins").value, ends: $("quiet-ends").value, days: QUIET_DAYS[$("quiet-days").value] }]);
  $("zone-change").onclick = changeZone;
  $("plan-waits").onchange = () => change("household/waits", { wanted: $("plan-waits").checked });
  $("plan-person").onchange = () => change("household/presence", { at_home: $("plan-person").checked });
  $("plans").ontoggle = () => { asked = 0; show(); };
  on("connection", () => { asked = 0; }); // a version means something within one connection only
  on("state", show);
}

function show() {
  const plans = get("state")?.plans;
  $("plans").hidden = !plans;
  if (!plans) return;
  put($("plans").querySelector("summary"), plans.waiting.length ? `Plans: ${plans.waiting.length} waiting` : "Plans");
  put($("plan-next"), now(plans));
  if ($("plans").open && plans.version !== asked) showAll(plans.version);
}

/** Return what is under way, waits and comes next, a sentence each. */
function now(plans) {
  const lines = plans.waiting.map((one) => `${title(one.plan)} was due ${day(one.due)}: ${one.reason || "it begins at once"}.`);
  if (plans.running) lines.unshift(`${title(plans.running)} is under way${plans.is_held ? ", paused while a person is at home" : ""}.`);
  lines.push(plans.next_at ? `Next: ${plans.next}, ${day(plans.next_at)}.` : "Nothing is planned.");
  return lines.join(" ");
}

/** Return what the server told last, or, before it has told anything, what it tells now. */
async function known() {
  if (!told) await showAll(get("state")?.plans?.version ?? 0);
  return told;
}

/** Ask for all plans, and show them. */
async function showAll(version) {
  asked = version;
  const before = changes, found = await ask("plans");
  if (!found || before !== changes) return;
  told = found;
  replaceLines($("plan-list"), told.plans.map(planLine));
  replaceLines($("preset-list"), told.presets.map(presetLine));
  $("needs").hidden = told.needs.length === 0;
  $("need-list").replaceChildren(...told.needs.map((need) => line(`${title(need.room)}: ${often(need.every)}; ${need.reason}.`)));
  replaceLines($("quiet-list"), told.quiet.map(quietLine));
  $("plan-waits").checked = told.waits_for_empty_home;
  $("plan-person").checked = told.is_person_home;
  $("plan-notes").replaceChildren(...told.notes.slice(0, MOST_NOTES).map((one) => line(`${day(one.at)} · ${one.plan}: ${one.text}`)));
  put($("plan-zone"), `Times are those of ${told.zone}.`);
}

/** Return how often a room is cleaned, of the times of its plan. */
function often(every) {
  if (every === null) return "each time";
  return every === 1 ? "each time" : `every ${every} times`;
}

function planLine(plan) {
  const { next, due, reason, ...values } = plan;
  const times = plan.at.map((time) => time.slice(0, 5)).join(", ");
  const made = entry(plan.name, `${daysInWords(plan.rule)} at ${times} · ${orderInWords(plan.order)}`);
  const toggle = button(plan.is_on ? "On" : "Off", () => change("plans", { ...values, is_on: !plan.is_on }), `${plan.name}: ${plan.is_on ? "on" : "off"}`);
  toggle.setAttribute("aria-pressed", String(plan.is_on));
  made.append(toggle, button("Edit", () => edit("Plan", values, true), `Edit ${plan.name}`), remover("plans", plan.name, values));
  return made;
}

function presetLine(preset) {
  const made = entry(preset.name, orderInWords(preset.order));
  const begin = button("Begin", async () => await mayEnd() && wish(`presets/${encodeURIComponent(preset.name)}/begin`), `Begin ${preset.name}`);
  begin.className = "moves";
  begin.disabled = !mayMove();
  made.append(
    begin,
    button("Edit", () => edit("Preset", preset, false), `Edit ${preset.name}`),
    remover("presets", preset.name, preset),
  );
  return made;
}

function quietLine(hours, index) {
  const days = hours.days.length === 7 ? "every day" : hours.days.map((one) => WEEK[one]).join(", ");
  const words = `${hours.begins.slice(0, 5)} to ${hours.ends.slice(0, 5)}`, made = entry(words, days);
  made.append(button("Remove", () => quiet(told.quiet.filter((_, other) => other !== index)), `Remove quiet hours ${words}`));
  return made;
}

function entry(name, about) {
  const item = document.createElement("li"), words = document.createElement("div");
  item.dataset.name = name;
  words.className = "words";
  words.append(span("name", name), span("about", about));
  item.append(words);
  return item;
}

/** Return a button that removes what can be brought back. */
function remover(kind, name, values) {
  return button("Remove", async () => {
    if (!await askYes(`Remove ${name}?`) || !await wish(`${kind}/${encodeURIComponent(name)}`, {}, "DELETE")) return;
    note(`${title(name)} is removed.`, () => change(kind, values));
  }, `Remove ${name}`);
}

async function edit(heading, given, isPlan) {
  if (!await known()) return;
  const path = isPlan ? "plans" : "presets", isNew = given.name === "", headers = isNew ? ONLY_NEW : {};
  // What is refused comes back into the form, with what was entered.
  let entered = await askPlan(heading, given, told.presets, isPlan, isNew, ""), fault = "";
  while (entered && (fault = await askFor(path, entered, "PUT", headers)))
    entered = await askPlan(heading, entered, told.presets, isPlan, isNew, sentence(fault));
  await showAll(get("state")?.plans?.version ?? 0);
}

async function changeZone() {
  if (!await known()) return;
  await askName("Time zone, such as Europe/Berlin", told.zone, (zone) => change("household/zone", { zone }, askFor), (zone, late) => {
    if (late) note(`${late}the time zone is ${zone} now.`);
  });
}

function quiet(hours) { return change("household/quiet", { quiet: hours }); }

/** Change something, and show what is so then, also where it was refused; returns what asking returned. */
async function change(path, body, asking = wish) {
  changes += 1;
  const answer = await asking(path, body, "PUT");
  changes += 1;
  await showAll(get("state")?.plans?.version ?? 0);
  return answer;
}

function orderInWords(order) {
  const what = order.mode === "rooms" ? order.rooms.join(", ") : { whole: "all floor", edges: "edges", dirtiest: "dirtiest first" }[order.mode];
  return `${what}${order.only_due ? ", only rooms that are due" : ""}, ${order.passes} ×, ${order.fan}`;
}

/** Return a moment as day and time of the home's zone, which its text has. */
function day(moment) {
  const date = new Date(`${moment.slice(0, 10)}T12:00Z`);
  return `${date.toLocaleDateString([], { weekday: "short", day: "numeric", month: "short", timeZone: "UTC" })} ${moment.slice(11, 16)}`;
}

function today() {
  const now = new Date();
  return new Date(now - 60_000 * now.getTimezoneOffset()).toISOString().slice(0, 10);
}

function line(text) {
  const made = document.createElement("li");
  made.textContent = text;
  return made;
}
