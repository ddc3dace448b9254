/** A card beside a place of the map: what can be done there. */
import { $, button } from "../dom.js";
import { toScreen } from "../map/view.js";
import { get, on } from "../store.js";
import { closed, opened } from "./opened.js";

const MARGIN = 8, BESIDE = 20; // pixels

let dismiss = null; // what is to be done when the card is closed without a choice

/** Let the card close when something else is touched. */
export function begin() {
  addEventListener("resize", close);
  on("link", () => { if (get("link") !== "live") close(); }); // what it offers may be old
  document.addEventListener("pointerdown", (event) => { if (!event.target.closest("#offer")) close(); }, true);
}

/** Open a card with a title and [words, act] for each button, beside a place, m; `otherwise` is done without a choice. */
export function open(words, acts, at, otherwise = null) {
  const place = $("offer");
  close();
  dismiss = otherwise;
  $("offer-title").textContent = words;
  $("offer-acts").replaceChildren(...acts.map(([text, act]) => button(text, () => { dismiss = null; close(); act(); })));
  place.hidden = false;
  opened("card", close);
  const { clientWidth: width, clientHeight: height } = place.parentElement, { offsetWidth, offsetHeight } = place, [px, py] = toScreen(...at);
  const above = py - BESIDE - offsetHeight, below = py + BESIDE;
  place.style.left = `${between(px - offsetWidth / 2, MARGIN, width - offsetWidth - MARGIN)}px`;
  place.style.top = `${between(below + offsetHeight > height - MARGIN ? above : below, MARGIN, height - offsetHeight - MARGIN)}px`;
}

/** Give the card the focus: it was opened by keys. */
export function focus() { $("offer-acts").firstElementChild.focus({ preventScroll: true }); }

/** Whether a card is open. */
export function isOpen() { return !$("offer").hidden; }

function between(value, least, most) { return Math.max(least, Math.min(value, most)); }

/** Take the card away. */
export function close() {
  if ($("offer").contains(document.activeElement)) $("floor").focus();
  $("offer").hidden = true;
  closed("card");
  dismiss?.();
  dismiss = null;
}
