/** Asks the viewer for a name, or for a yes. */
import { $ } from "../dom.js";

/** Return the text that was entered, or null. */
export function askName(title, text) { return ask(title, text); }

/** Return whether the answer was yes. */
export async function askYes(title) { return (await ask(title, null)) !== null; }

function ask(title, text) {
  const dialog = $("ask");
  $("ask-title").textContent = title;
  $("ask-label").hidden = text === null;
  $("ask-text").value = text ?? "";
  $("ask-text").required = text !== null;
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.onclose = () => resolve(dialog.returnValue === "yes" ? $("ask-text").value : null);
  });
}
