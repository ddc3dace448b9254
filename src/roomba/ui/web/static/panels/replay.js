/** The time line of a recorded run: play, pause, drag, speed. */
import { $, put } from "../dom.js";
import { BASE, wish } from "../link.js";
import { get, on } from "../store.js";
import { duration } from "../words.js";

const PERIOD = 100; // ms between two wishes while the time line is dragged

let dragged = null; // the time that is wished for, until the server has heard of it
let sending = false;

/** Connect the controls, and follow the recording. */
export function begin() {
  $("replay-play").onclick = playOrPause;
  $("replay-at").oninput = () => { dragged = Number($("replay-at").value); send(); };
  $("replay-speed").onchange = () => wish("replay", { speed: Number($("replay-speed").value) });
  $("replay-back").hidden = !/\/replay\/\d+\/$/.test(BASE); // it lies within the page of a robot
  on("state", show);
}

/** Whether the page shows a recording. */
export function isShown() { return Boolean(get("state")?.replay); }

/** Let the recording go on, or stand. */
export function playOrPause() { return wish("replay", { playing: !get("state").replay.playing }); }

/** Wish for the newest time, one wish at a time. */
async function send() {
  if (sending) return;
  sending = true;
  while (dragged !== null) {
    const at = dragged;
    await wish("replay", { at });
    await new Promise((resolve) => setTimeout(resolve, PERIOD));
    if (dragged === at) dragged = null;
  }
  sending = false;
}

function show() {
  const replay = get("state")?.replay;
  $("timeline").hidden = !replay;
  document.body.dataset.replay = replay ? "yes" : "no";
  if (!replay) return;
  const at = dragged ?? replay.at, slider = $("replay-at"), speed = String(replay.speed);
  put($("replay-play"), replay.playing ? "Pause" : "Play");
  slider.max = replay.duration;
  if (dragged === null) slider.value = at;
  slider.setAttribute("aria-valuetext", `${duration(at)} of ${duration(replay.duration)}`);
  put($("replay-time"), `${clock(at)} / ${clock(replay.duration)}`);
  if ($("replay-speed").value !== speed) $("replay-speed").value = speed;
}

function clock(seconds) {
  const whole = Math.floor(seconds), part = (value) => String(value).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${part(Math.floor(whole / 60) % 60)}:${part(whole % 60)}`;
}
