/** What is open or selected, the newest last: the browser's way back closes it one by one, and so does Escape. */

const HELD = "opened"; // in the state of the entry of the browser's history that the way back takes away
const things = []; // [name, how it is closed]
let isHeld = Boolean(history.state?.[HELD]); // whether the entry that is shown is that one

/** Listen to the way back, and to dialogs that close. */
export function begin() {
  for (const dialog of document.querySelectorAll("dialog")) dialog.addEventListener("close", () => closed(dialog.id));
  addEventListener("popstate", () => {
    const wasHeld = isHeld;
    isHeld = Boolean(history.state?.[HELD]);
    if (isHeld || !wasHeld) return; // it was the way forward, or an address that was typed
    if (!closeNewest()) history.back(); // all was closed before: the page is left
    else if (things.length) hold();
  });
}

/** Something is open now; `close()` closes it. */
export function opened(name, close) {
  if (things.some(([one]) => one === name)) return;
  things.push([name, close]);
  hold();
}

/** Something is no longer open. */
export function closed(name) {
  const at = things.findIndex(([one]) => one === name);
  if (at >= 0) things.splice(at, 1);
}

/** Show a dialog until it is closed. */
export function showDialog(dialog) {
  dialog.showModal();
  opened(dialog.id, () => dialog.close());
}

/** Close the newest that is none of those that stay; returns whether there was one. */
export function closeNewest(...stay) {
  const newest = things.findLast(([name]) => !stay.includes(name));
  if (newest) {
    closed(newest[0]);
    newest[1]();
  }
  return Boolean(newest);
}

/** Remember whether a part of the page is shown, for when the browser comes back to it from elsewhere. */
export function remember(part, isShown) { history.replaceState({ ...history.state, [part]: isShown }, ""); }

/** Whether a part of the page was shown when the browser left it. */
export function wasShown(part) { return Boolean(history.state?.[part]); }

function hold() {
  if (!isHeld) history.pushState({ [HELD]: true }, "");
  isHeld = true;
}
