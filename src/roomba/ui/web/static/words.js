/** The robot's state in words that a person would say. */

const SOON = 90; // s
const LATER = 7200; // s from which minutes do not matter
const MOVES = 0.02; // m/s
const FULL = 0.995; // of a battery
const NOTHING = 0.01; // of the floor that was wanted
const MOST_TOLD = 3; // rooms that a sentence lists
const OPEN = "the map is open"; // how the part of a message begins that tells of open edges
const UNTOLD = ["stopped", "refused", "disconnected"]; // ends that were wished for, or are told elsewhere
const EARLY = { interrupted: "interrupted", "not docked": "done, but not docked" }; // how a run ended, where it did not merely end early
const HELPS = { // what is to be done, by why floor was missed, or the map stays open
  shut: "Open it or clear the way, then clean there again.",
  thing: "Take it away, then clean there again.",
  "not looked at": "Open doors and clear the way before it makes a map anew.",
};
const GO_ON = "Clean again what is left."; // after a run that was interrupted
const TROUBLES = { // of a robot on a line: the headline
  unreachable: "Cannot reach the robot",
  "sensor silent": "The robot stands: a sensor is silent",
  disobeys: "The robot does not obey",
};

/** Return the headline for a state. */
export function headline(link, state) {
  if (link === "connecting") return "Connecting …";
  if (link === "gone") return "The robot does not answer";
  if (!state || link === "reconnecting") return "Connecting again …";
  if (state.replay) return `Recorded: ${headline(link, { ...state, replay: null })}`;
  const trouble = troubleOf(state);
  if (trouble) return trouble;
  const { vacuum } = state, room = (vacuum.room ? ` · ${title(vacuum.room)}` : "") + (vacuum.is_on_carpet ? " · on carpet" : "");
  if (state.truth?.lifted) return "Lifted off the floor";
  if (waits(vacuum)) return `Waiting for a way to open${room}`;
  switch (vacuum.phase) {
    case "docked": return vacuum.charges && vacuum.battery < FULL ? "On its station, charging" : "On its station, ready";
    case "charging": return "Charging, then it goes on";
    case "idle": return moves(state) ? `On its way${room}` : `Standing${room}`;
    case "undocking": return "Leaving its station";
    case "cleaning": return `${isElsewhere(vacuum) ? `On its way to ${title(vacuum.queue[0])}` : `Cleaning${room}`}`;
    case "exploring": return "Looking at what it does not know yet";
    case "returning": return "On its way home";
    case "docking": return "Docking";
    case "emptying": return "Its station empties its bin";
    case "bin full": return "Its dust bin is full";
    case "paused": return moves(state) ? `On its way${room}` : `Paused${room}`;
    case "error": return "It needs help";
    case "emergency stop": return "Stopped by the emergency stop";
    default: return vacuum.phase;
  }
}

function troubleOf({ vacuum }) { return TROUBLES[vacuum.hindrance]; }

/** Return how long it still cleans; empty when it does not. This changes all the time, and is not read out. */
export function toGo(link, state) {
  if (!state || !["live", "stale"].includes(link) || troubleOf(state)) return "";
  const { seconds_to_go: seconds, phase } = state.vacuum;
  return seconds > 0 && phase === "cleaning" ? ` · ${duration(seconds)} to go` : "";
}

/** Whether it stands before a door that is shut, or something else in its way, until that is gone. */
function waits(vacuum) { return vacuum.hindrance === "no way"; }

/** Return why it waits, without the numbers of places, when it looks again, and what helps. */
function waiting({ phase, looks_within: seconds }) {
  const looks = seconds ? ` It looks again within ${duration(seconds)}.` : "";
  return `${phase === "returning" ? "No way home" : "No way leads on"}.${looks} Open a door or clear the way, and it goes on.`;
}

function moves(state) { return state.speed > MOVES; }

/** Whether the robot stands, and waits for what it is told. */
export function stands(state) { return Boolean(state) && ["docked", "idle", "paused"].includes(state.vacuum.phase) && !moves(state); }

/** Whether it is not yet in the room that it cleans next. */
function isElsewhere({ queue, room }) { return queue?.length > 0 && queue[0] !== room; }

/** Return why it does not do what was asked, and what helps; empty when all is well. */
export function explanation(link, state, reason, heardAt) {
  const seen = heardAt ? ` Last seen at ${new Date(heardAt).toLocaleTimeString()}.` : "";
  if (link === "gone") return `${sentence(reason.replaceAll("`", ""))}${seen}`;
  if (link === "stale") return "No news: what is shown is old.";
  if (link === "reconnecting") return `The page comes back by itself as soon as the robot's program answers.${seen}`;
  if (!state) return "";
  if (state.held) return `The drive is held: ${state.held}. “Release” lets it go; then it stands until “Go on”, or another order.`;
  if (state.truth?.lifted) return "Put it down: drag it, or tap the floor and “Put the robot here”.";
  if (state.vacuum.hindrance === "bin full") return "Empty the dust bin, then press “Bin emptied”.";
  if (waits(state.vacuum)) return waiting(state.vacuum);
  return sentence(state.vacuum.message || state.doubt);
}

/** Return how old is what is shown; this changes all the time, and is not read out. */
export function oldness(link, age) { return link === "stale" ? `It was heard ${Math.round(age / 1000)} s ago.` : ""; }

/** Return a text as a sentence. */
export function sentence(text) {
  return text ? title(text) + (/[.!?]$/.test(text) ? "" : ".") : "";
}

/** Return a name as a title. */
export function title(name) { return name.charAt(0).toUpperCase() + name.slice(1); }

/** Return a time, s, in words. */
export function duration(seconds) {
  if (seconds < SOON) return `${Math.round(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 90) return `${minutes} min`;
  const shown = seconds < LATER ? minutes : 10 * Math.round(minutes / 10);
  return `${Math.floor(shown / 60)} h ${shown % 60} min`;
}

/** Return how the last run ended; what the map's open edges say is listed beside it. */
export function lastRun(report) {
  const parts = [title(report.outcome)], told = report.message.split("; ");
  const message = report.open_edges?.length ? told.filter((part) => !part.startsWith(OPEN)).join("; ") : report.message;
  if (report.mapped) parts.push(`${report.mapped.toFixed(1)} m² mapped`);
  if (report.wanted) parts.push(`${report.covered.toFixed(1)} of ${report.wanted.toFixed(1)} m²`);
  if (report.duration) parts.push(duration(report.duration));
  if (report.wanted && report.rate) parts.push(`${report.rate.toFixed(2)} m² a minute`);
  if (report.dirt) parts.push(`${report.dirt.toFixed(1)} g of dirt`);
  return parts.join(" · ") + (message ? `. ${sentence(message)}` : "");
}

/** Return why a clean achieved nothing; empty when it was told to stop, or achieved something. */
function nothingDone({ outcome, covered, wanted, message, missed }) {
  if (outcome === "stopped" || !wanted || covered > NOTHING * wanted) return "";
  const reason = message || missed[0]?.reason;
  return reason ? sentence(`Nothing was cleaned: ${reason}`) : "";
}

/** Return how the last run fell short of what was asked for, why, and what helps; empty when it did not. */
export function shortfall(report) {
  if (!report || UNTOLD.includes(report.outcome)) return "";
  const text = nothingDone(report) || (report.outcome === "completed" ? notAll(report) : endedEarly(report));
  return [text, text && help(report)].filter(Boolean).join(" ");
}

/** Return what helps where a run fell short; empty where that is not known. */
function help({ outcome, missed, open_edges: edges }) {
  if (outcome === "interrupted") return GO_ON;
  const reasons = missed.length ? missed.slice(0, 1) : edges ?? [];
  const codes = new Set(reasons.map(({ code }) => code)); // of several, “Last run” tells
  return outcome === "completed" && codes.size === 1 ? HELPS[[...codes][0]] : "";
}

/** Return by which letter an open edge of the map is called: rooms have numbers. */
export function letter(index) { return index < 26 ? String.fromCharCode(65 + index) : String(index + 1); }

/** Return how an open edge is told. */
export function edgeText({ length, reason }) { return `${length.toFixed(1)} m: ${reason}`; }

/** Return where the map stays open after an exploration, and why; empty where it is whole. */
function openMap({ mapped, open_edges: edges }) {
  if (!mapped || !edges.length) return "";
  const reasons = new Set(edges.map((edge) => edge.reason)), length = edges.reduce((sum, edge) => sum + edge.length, 0);
  const where = `The map stays open for ${length.toFixed(1)} m in ${edges.length === 1 ? "one place" : `${edges.length} places`}`;
  return `${where}: ${reasons.size === 1 ? sentence(edges[0].reason).replace(/^./, (first) => first.toLowerCase()) : "“Last run” lists why."}`;
}

/** Return what of a run that came to its end the robot finds worth telling: where floor was left, and why. */
function notAll({ covered, wanted, message, missed, ...report }) {
  if (!wanted) return openMap(report);
  if (!message) return "";
  const [{ reason, room } = {}] = missed, rooms = [...new Set(missed.filter((miss) => miss.reason === reason && miss.room).map((miss) => miss.room))];
  const more = rooms.length > MOST_TOLD ? ` and ${rooms.length - MOST_TOLD} more` : "";
  const why = room ? `${rooms.slice(0, MOST_TOLD).map(title).join(", ")}${more}: ${reason}` : message;
  return `Last run: ${areas(covered, wanted)}. ${sentence(why)}`;
}

function endedEarly({ outcome, covered, wanted, message }) {
  const parts = [EARLY[outcome] ?? "ended early"];
  if (wanted) parts.push(areas(covered, wanted));
  return `Last run: ${parts.join(", ")}. ${sentence(message)}`;
}

function areas(covered, wanted) { return `${covered.toFixed(1)} of ${wanted.toFixed(1)} m² clean`; }

/** What is said of ways to clean that need no more than their name. */
export const MODES = { whole: "all floor", edges: "edges only", dirtiest: "dirtiest rooms first" };
/** And of carpets, and of edges. */
export const CARPETS = { boost: "stronger", "as elsewhere": "as elsewhere", avoid: "left out" };
export const EDGES = { any: "on the way", first: "first", last: "last" };
/** What zones are. */
export const ZONES = { "no-go": "no-go", wall: "virtual wall", carpet: "carpet" };
