/** Elements of the page. */

/** Return the element of an id. */
export const $ = (id) => document.getElementById(id);

/** Write a text only when it is another one: screen readers tell each change. */
export function put(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
