/** Asks the viewer for a name, or for a yes. */
import { $, put } from "../dom.js";
import { sentence } from "../words.js";
import { showDialog } from "./opened.js";

const LATE = "It was too late to cancel: "; // what the robot did before it heard of that is told

/**
 * Ask for a name until it is taken: `take(name)` returns why it is refused, empty when it is not. What was entered stays,
 * with the reason. `taken(name, late)` is called when it is; where Cancel came before the answer, `late` says so.
 */
export function askName(title, text, take, taken) { return ask(title, text, take, taken); }

/** Return whether the answer was yes. */
export function askYes(title) { return ask(title, null, async () => "", () => {}); }

/** Return whether it was taken before the dialog was closed. */
function ask(title, text, take, taken) {
  const dialog = $("ask");
  let isAnswered = false; // an answer may come when the dialog asks for something else
  $("ask-title").textContent = title;
  $("ask-label").hidden = text === null;
  $("ask-text").value = text ?? "";
  $("ask-text").required = text !== null;
  dialog.querySelector("form").onsubmit = async (event) => {
    if (event.submitter?.value === "no") return;
    event.preventDefault();
    const name = $("ask-text").value, fault = await take(name), isLate = isAnswered;
    if (fault === null) return;
    if (!isLate) showFault(fault);
    if (!isLate && !fault) dialog.close("yes");
    if (!fault) taken(name, isLate ? LATE : "");
  };
  showFault("");
  dialog.returnValue = "";
  showDialog(dialog);
  return new Promise((resolve) => {
    dialog.onclose = () => { isAnswered = true; resolve(dialog.returnValue === "yes"); };
  });
}

function showFault(fault) {
  put($("ask-fault"), sentence(fault));
  $("ask-fault").hidden = !fault;
}
