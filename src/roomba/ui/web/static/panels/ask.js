/** Asks the viewer for a name, or for a yes. */
import { $, put } from "../dom.js";
import { sentence } from "../words.js";
import { showDialog } from "./opened.js";

/**
 * Ask for a name until it is taken: `take(name)` returns why it is refused, empty when it is not. Returns the name, or
 * null. What was entered stays, with the reason.
 */
export function askName(title, text, take) { return ask(title, text, take); }

/** Return whether the answer was yes. */
export async function askYes(title) { return (await ask(title, null, async () => "")) !== null; }

function ask(title, text, take) {
  const dialog = $("ask");
  let isAnswered = false; // an answer may come when the dialog asks for something else
  $("ask-title").textContent = title;
  $("ask-label").hidden = text === null;
  $("ask-text").value = text ?? "";
  $("ask-text").required = text !== null;
  dialog.querySelector("form").onsubmit = async (event) => {
    if (event.submitter?.value === "no") return;
    event.preventDefault();
    const fault = await take($("ask-text").value);
    if (isAnswered || fault === null) return;
    showFault(fault);
    if (!fault) dialog.close("yes");
  };
  showFault("");
  dialog.returnValue = "";
  showDialog(dialog);
  return new Promise((resolve) => {
    dialog.onclose = () => { isAnswered = true; resolve(dialog.returnValue === "yes" ? $("ask-text").value : null); };
  });
}

function showFault(fault) {
  put($("ask-fault"), sentence(fault));
  $("ask-fault").hidden = !fault;
}
