/** The rooms that a clean under way has still to do: put in another order, left out, added. */
import { $, button, span } from "../dom.js";
import { note, wish } from "../link.js";
import { get, on, set } from "../store.js";
import { title } from "../words.js";
import { how } from "./actions.js";
import { movers } from "./order.js";

let shown = "";

/** Keep the list up to date. */
export function begin() {
  on("state", show);
}

/** Return the rooms that are still to be cleaned, the present one first. */
export function rooms() { return get("state")?.vacuum.queue ?? []; }

/** Return the rooms that are chosen, and not yet among them. */
export function more() { return get("chosen").filter((name) => !rooms().includes(name)); }

/** Let the robot go on with these; what was so before can be had back. */
async function change(names, text) {
  const before = wishFor(rooms());
  if (!await wish("queue", wishFor(names), "PUT")) return false;
  note(text, () => wish("queue", before, "PUT"));
  return true;
}

/** Return what is wished of rooms: each is cleaned as it was to be, and one that comes in as its choices say. */
function wishFor(names) {
  const { queue, queue_ways: ways } = get("state").vacuum, { passes, fan } = how(), hows = get("hows");
  return { rooms: names, each: names.map((name) => ways[queue.indexOf(name)] ?? { passes, fan, ...hows[name] }) };
}

/** Let the robot clean the chosen ones as well. */
export async function add() {
  const added = more();
  if (await change([...rooms(), ...added], `${added.map(title).join(", ")}: to be cleaned as well.`)) set("chosen", []);
}

function show() {
  const queue = rooms();
  $("queue").hidden = queue.length === 0 || Boolean(get("state")?.replay);
  const key = queue.join("\n");
  if (key === shown) return;
  shown = key;
  const focused = document.activeElement?.closest("#queue-list") ? document.activeElement.getAttribute("aria-label") : null;
  $("queue-list").replaceChildren(...queue.map((name, index) => entry(queue, name, index)));
  if (focused) [...$("queue-list").querySelectorAll("button")].find((one) => one.getAttribute("aria-label") === focused && !one.disabled)?.focus();
}

function entry(queue, name, index) {
  const item = document.createElement("li"), last = queue.length - 1, called = title(name);
  const out = button("✕", () => change(queue.filter((one) => one !== name), `${called} is left out.`), `Leave ${called} out`);
  out.disabled = last === 0;
  item.append(span("name", index === 0 ? `${called}, now` : called), ...movers(queue, index, change), out);
  return item;
}
