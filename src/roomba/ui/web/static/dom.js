/** Elements of the page. */

/** Return the element of an id. */
export const $ = (id) => document.getElementById(id);

/** Write a text only when it is another one: screen readers tell each change. */
export function put(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Return a button that does something; its label, where the text alone does not say it. */
export function button(text, act, label) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  if (label) made.setAttribute("aria-label", label);
  made.onclick = act;
  return made;
}

/** Replace the lines of a list; the button that has the focus keeps it in the new line of the same name. */
export function replaceLines(list, lines) {
  const focused = document.activeElement, line = list.contains(focused) ? focused.closest("li") : null;
  const index = line ? [...line.querySelectorAll("button")].indexOf(focused) : -1;
  list.replaceChildren(...lines);
  if (line) lines.find((one) => one.dataset.name === line.dataset.name)?.querySelectorAll("button")[index]?.focus();
}

/** Return a part of a line of text. */
export function span(kind, text) {
  const made = document.createElement("span");
  made.className = kind;
  made.textContent = text;
  return made;
}

/** Let a select offer [value, words], and keep what is chosen if it is still there. */
export function offer(select, options, chosen = select.value) {
  select.replaceChildren(...options.map(([value, words]) => new Option(words, value)));
  if (options.some(([value]) => String(value) === String(chosen))) select.value = String(chosen);
}
