/** The newest snapshots of the robot, and what the viewer has chosen on this page. */

/** @type {Record<string, any>} */
const values = {
  link: "connecting", connection: 0, age: 0, state: null, home: null, limits: null, mayChange: null, hasHistory: false, hasCamera: false, hasMaps: false,
  trail: [], chosen: [], hows: {}, drawing: null, zone: null, edge: null, carried: null,
  layers: { coverage: true, trail: true, path: true, rooms: true, furniture: true, zones: true, carpets: true, edges: true, scan: false, dirt: false, truth: false },
};
const listeners = new Map();

/** Return what is known by a name. */
export function get(name) { return values[name]; }

/** Replace what is known by a name, and tell those who listen. */
export function set(name, value) {
  values[name] = value;
  for (const listener of listeners.get(name) ?? []) listener(value);
}

/** Call a function now and whenever one of the names changes. */
export function on(names, listener) {
  for (const name of names.split(" ")) {
    if (!listeners.has(name)) listeners.set(name, []);
    listeners.get(name).push(() => listener());
  }
  listener();
}

/** Return the zone that is chosen, where it is being moved to or else where the robot has it; undefined without one. */
export function chosenZone() {
  const chosen = get("zone"), zone = get("home")?.zones.find((one) => one.name === chosen?.name);
  return zone && { ...zone, points: chosen.points ?? zone.points };
}

/** Show the chosen zone where it is being moved to; with nothing, where the robot has it. */
export function moveZone(points) {
  const chosen = get("zone");
  if (chosen && chosen.points !== points) set("zone", { name: chosen.name, points });
}

/** Return where the map of the last run stays open. */
export function openEdges() { return get("state")?.last?.open_edges ?? []; }

/** Whether the server is there. */
export function isConnected() { return ["live", "stale"].includes(get("link")); }

/** Whether this page may ask the robot for something: the server is there, it has the token, and shows no recording. */
export function mayAsk() { return isConnected() && get("mayChange") !== false && !get("state")?.replay; }

/** Whether it may ask for what sets the robot in motion: what is shown is not old, either. */
export function mayMove() { return mayAsk() && get("link") === "live"; }

/** Whether the robot offers a way to play with its home. */
export function offers(act) { return Boolean(get("limits")?.play.includes(act)); }
