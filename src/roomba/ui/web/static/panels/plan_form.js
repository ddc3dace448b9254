/** The form of a plan or a preset: days, times, rooms, passes, fan. */
import { $, offer } from "../dom.js";
import { get } from "../store.js";
import { CARPETS, EDGES } from "../words.js";
import { numbers } from "./actions.js";
import { showDialog } from "./opened.js";

const DAYS = { MO: "Mon", TU: "Tue", WE: "Wed", TH: "Thu", FR: "Fri", SA: "Sat", SU: "Sun" };
const WHAT = [["whole", "all floor"], ["rooms", "rooms"], ["edges", "edges only"], ["dirtiest", "dirtiest rooms first"]];

/** Return a rule in words: “Mon, Thu”, “every day”. */
export function daysInWords(rule) {
  const parts = parsed(rule);
  if (!parts) return rule;
  const days = parts.days.length === 7 ? "every day" : parts.days.map((day) => DAYS[day]).join(", ");
  return parts.weeks > 1 ? `${days}, every ${parts.weeks} weeks` : days;
}

/** Ask for a plan, or with no times for a preset; `fault` tells what is wrong with it. Returns it, or null. */
export function askPlan(title, given, presets, isPlan, isNew, fault) {
  const dialog = $("plan-form");
  $("plan-form-title").textContent = title;
  $("plan-when").hidden = !isPlan;
  $("plan-name").value = given.name;
  $("plan-name").readOnly = !isNew;
  if (isPlan) showWhen(given);
  $("plan-preset-label").hidden = !isPlan || presets.length === 0;
  offer($("plan-preset"), [["", "–"], ...presets.map((preset) => [preset.name, preset.name])], "");
  $("plan-preset").onchange = () => {
    const preset = presets.find((one) => one.name === $("plan-preset").value);
    if (preset) showOrder(preset.order);
  };
  $("plan-mode").onchange = showRooms;
  dialog.querySelector("form").onsubmit = (event) => {
    const fault = event.submitter?.value === "yes" ? missing(isPlan) : "";
    if (!fault) return;
    event.preventDefault();
    showFault(fault);
  };
  showOrder(given.order);
  dialog.returnValue = "";
  showDialog(dialog);
  showFault(fault);
  return new Promise((resolve) => {
    dialog.onclose = () => resolve(dialog.returnValue === "yes" ? entered(given, isPlan) : null);
  });
}

/** Return what is still to be entered; empty when nothing is. */
function missing(isPlan) {
  if (!$("plan-name").value.trim()) return "Give it a name.";
  return isPlan && !$("plan-rule").value.trim() && !checked("plan-days").length ? "Choose at least one day." : "";
}

function showFault(fault) {
  $("plan-fault").textContent = fault;
  $("plan-fault").hidden = !fault;
  if (fault) $("plan-fault").scrollIntoView(); // it stands above the first field
}

function showWhen(plan) {
  const parts = parsed(plan.rule);
  $("plan-days").onchange = () => { $("plan-rule").value = ""; }; // else it would overrule them
  $("plan-days").replaceChildren(...Object.entries(DAYS).map(([day, name]) => box(day, name, parts?.days.includes(day))));
  $("plan-weeks").value = String(parts?.weeks ?? 1);
  $("plan-rule").value = parts ? "" : plan.rule;
  $("plan-at").value = plan.at.map((time) => time.slice(0, 5)).join(", ");
}

function showOrder(order) {
  const limits = get("limits");
  offer($("plan-mode"), WHAT, order.mode);
  offer($("plan-passes"), numbers(limits?.most_passes ?? 1), order.passes);
  $("plan-due").checked = Boolean(order.only_due);
  offer($("plan-fan"), (limits?.fans ?? [order.fan]).map((fan) => [fan, fan]), order.fan);
  offer($("plan-carpets"), (limits?.carpets ?? [order.carpets]).map((way) => [way, CARPETS[way] ?? way]), order.carpets);
  offer($("plan-edges"), (limits?.edges ?? [order.edges]).map((when) => [when, EDGES[when] ?? when]), order.edges);
  // Rooms that there are not any more stay chosen until they are taken out here.
  const names = [...new Set([...(get("home")?.rooms ?? []).map((room) => room.name), ...order.rooms])];
  $("plan-rooms").replaceChildren(...names.map((name) => box(name, name, order.rooms.includes(name))));
  showRooms();
}

function showRooms() {
  $("plan-rooms-set").hidden = $("plan-mode").value !== "rooms";
  $("plan-due-label").hidden = $("plan-when").hidden || !canBeDue();
}

/** Whether of what is chosen those rooms alone can be cleaned that are due. */
function canBeDue() { return ["whole", "rooms"].includes($("plan-mode").value); }

function entered(given, isPlan) {
  const mode = $("plan-mode").value, rooms = mode === "rooms" ? checked("plan-rooms") : [];
  const order = { mode, rooms, passes: Number($("plan-passes").value), fan: $("plan-fan").value, carpets: $("plan-carpets").value, edges: $("plan-edges").value, only_due: isPlan && canBeDue() && $("plan-due").checked };
  const name = $("plan-name").value.trim();
  if (!isPlan) return { name, order };
  const at = $("plan-at").value.split(/[\s,;]+/).filter(Boolean).map((time) => time.replace(/^\d:/, "0$&"));
  return { name, is_on: given.is_on, begins: given.begins, rule: $("plan-rule").value.trim() || rule(), at, order };
}

function rule() {
  const days = checked("plan-days"), weeks = Number($("plan-weeks").value);
  if (days.length === 7 && weeks === 1) return "FREQ=DAILY";
  return `FREQ=WEEKLY;BYDAY=${days.join(",")}${weeks > 1 ? `;INTERVAL=${weeks}` : ""}`;
}

/** Return days and weeks of a rule that the boxes can show, else null. */
function parsed(rule) {
  const parts = Object.fromEntries(rule.toUpperCase().split(";").map((part) => part.split("=")));
  const { FREQ, INTERVAL = "1", BYDAY = "", ...others } = parts, days = BYDAY.split(",").filter(Boolean);
  if (Object.keys(others).length) return null;
  if (FREQ === "DAILY" && INTERVAL === "1" && !days.length) return { days: Object.keys(DAYS), weeks: 1 };
  const isShown = FREQ === "WEEKLY" && days.length && days.every((day) => day in DAYS) && ["1", "2", "3", "4"].includes(INTERVAL);
  return isShown ? { days: Object.keys(DAYS).filter((day) => days.includes(day)), weeks: Number(INTERVAL) } : null;
}

function checked(id) { return [...$(id).querySelectorAll("input:checked")].map((one) => one.value); }

function box(value, text, isChecked) {
  const label = document.createElement("label"), made = document.createElement("input");
  made.type = "checkbox";
  made.value = value;
  made.checked = Boolean(isChecked);
  label.className = "check";
  label.append(made, text);
  return label;
}
