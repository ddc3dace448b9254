/** No-go zones that the robot offers, where it felt again and again what its lidar does not see. */
import { $ } from "../dom.js";
import { note, wish } from "../link.js";
import { middleOf } from "../map/plan.js";
import { get, on } from "../store.js";
import { newName } from "./zones.js";
import { open } from "./sheet.js";

/** Keep the offers up to date. */
export function begin() { on("home", show); }

function show() {
  const things = get("home")?.low_things ?? [];
  $("low-offer").hidden = things.length === 0;
  if (things.length && !document.querySelector(".panel").dataset.open) open("rooms");
  // What is still offered stays where it is: a tap on what is drawn anew meanwhile would be lost.
  const list = $("low-offers"), wanted = new Map(things.map((thing) => [JSON.stringify(thing), thing]));
  for (const item of [...list.children]) if (!wanted.delete(item.dataset.thing)) item.remove();
  for (const [key, thing] of wanted) {
    const item = entry(thing);
    item.dataset.thing = key;
    list.append(item);
  }
}

function entry({ times, corners }) {
  const item = document.createElement("li"), text = document.createElement("span");
  const [x, y] = middleOf(corners), place = `at ${x.toFixed(1)}, ${y.toFixed(1)}`;
  text.textContent = `Felt ${times} times ${place}: make it a no-go zone?`;
  item.append(
    text,
    button("No-go zone", `Make a no-go zone ${place}`, async () => {
      const zone = { name: newName("no-go"), kind: "no-go", points: corners };
      if (await wish("zones", zone, "PUT")) note(`${zone.name} is added.`, () => wish(`zones/${encodeURIComponent(zone.name)}`, {}, "DELETE"));
    }),
    button("Ignore", `Ignore what was felt ${place}`, async () => {
      if (await wish("low_things/ignore", { x, y })) note("It is not offered again.");
    }),
  );
  return item;
}

function button(text, label, act) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  made.setAttribute("aria-label", label);
  made.onclick = act;
  return made;
}
