/** On a phone, the sheet above the buttons: a tab opens its part, again or a swipe down closes it. */
import { closed, opened } from "./opened.js";

const SWIPE = 30; // pixels

const panel = document.querySelector(".panel");
const tabs = [...document.querySelectorAll("[data-tab]")];

/** Connect the tabs. */
export function begin() {
  for (const tab of tabs) tab.onclick = () => open(panel.dataset.open === tab.dataset.tab ? null : tab.dataset.tab);
  let from = null;
  panel.addEventListener("pointerdown", (event) => { from = event.target.closest(".parts") ? null : event.clientY; });
  panel.addEventListener("pointerup", (event) => {
    if (from === null) return;
    const up = from - event.clientY;
    from = null;
    if (up > SWIPE && !panel.dataset.open) open("rooms");
    else if (up < -SWIPE) open(null);
  });
}

/** Open a part, or close the sheet. */
export function open(name) {
  if (name) panel.dataset.open = name; else delete panel.dataset.open;
  if (name && tabs[0].offsetParent) opened("sheet", () => open(null)); else closed("sheet");
  for (const tab of tabs) tab.setAttribute("aria-expanded", String(tab.dataset.tab === name));
}
