/** An ordered list: two buttons at each entry move it up and down. */
import { button } from "../dom.js";
import { title } from "../words.js";

/** Return the buttons that move the entry of an index: each gives `take` the new order, and what is done in words. */
export function movers(names, index, take, label = (text) => text) {
  const called = title(names[index]), last = names.length - 1;
  const earlier = button("▲", () => take(moved(names, index, index - 1), `${called} comes earlier.`), label(`${called} earlier`));
  const later = button("▼", () => take(moved(names, index, index + 1), `${called} comes later.`), label(`${called} later`));
  earlier.className = later.className = "mover";
  earlier.disabled = index === 0;
  later.disabled = index === last;
  return [earlier, later];
}

function moved(names, from, to) {
  const found = [...names];
  found.splice(to, 0, ...found.splice(from, 1));
  return found;
}
