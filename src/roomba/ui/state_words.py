"""A robot's state in words, as a person reads it."""

from __future__ import annotations

import math
from datetime import datetime
from typing import Any

from roomba.ui.errand_progress import area_text, percent, to_go_text


def lines_of(state: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what is worth knowing of a state of the API: names and values, in order."""
    vacuum = state["vacuum"]
    does = [vacuum["state"]]
    if vacuum["phase"] != vacuum["state"]:
        does.append(vacuum["phase"])
    if vacuum["room"]:
        does.append(f"in {vacuum['room']}")
    if vacuum.get("is_on_carpet"):
        does.append("on carpet")
    lines = [("state", ", ".join(does)), ("battery", percent(_number(vacuum["battery"])))]
    if vacuum["wanted"] > 0.0:
        cleaned = [area_text(vacuum["covered"], vacuum["wanted"])]
        to_go = to_go_text(vacuum["seconds_to_go"])
        lines.append(("cleaned", ", ".join([*cleaned, to_go] if to_go else cleaned)))
    x, y, heading = (round(value, 2) + 0.0 for value in state["pose"])  # and no minus before 0
    if state["dirt"] is not None:
        lines.append(("dirt", f"{state['dirt']:.1f} g picked up since the bin was emptied"))
    lines.append(("place", f"x {x:.2f} m, y {y:.2f} m, heading {math.degrees(heading):.0f}°"))
    lines.append(("speed", f"{state['speed']:.2f} m/s"))
    if state["last"] is not None:
        lines.append(("last", _ended(state["last"])))
    lines.extend(("upkeep", advice) for advice in state.get("upkeep", {}).get("reminders", ()))
    lines.extend(_planned(state.get("plans", {})))
    troubles = (vacuum["message"], state["held"] and f"held: {state['held']}", state["doubt"])
    lines.extend(("trouble", trouble) for trouble in troubles if trouble)
    return lines


def _planned(plans: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the next plan, and which plans wait and why, as text."""
    lines = []
    if plans.get("running"):
        held = ", paused while a person is at home" if plans["is_held"] else ""
        lines.append(("plan", f"{plans['running']}: under way{held}"))
    lines.extend(
        ("plan", f"{waits['plan']}: was due {_when(waits['due'])}, waits: {waits['reason']}")
        for waits in plans.get("waiting", ())
    )
    if plans.get("next_at"):
        lines.append(("next", f"{plans['next']}, {_when(plans['next_at'])}"))
    return lines


def _when(moment: str) -> str:
    """Return a moment of ISO 8601 as day and time in its own zone."""
    return f"{datetime.fromisoformat(moment):%a %d %b %H:%M}"


def _ended(last: dict[str, Any]) -> str:
    """Return how the last errand ended."""
    parts = [str(last["outcome"])]
    if _number(last["wanted"]) > 0.0:
        parts.append(area_text(_number(last["covered"]), last["wanted"]))
    if last.get("rate") is not None and _number(last["wanted"]) > 0.0:
        parts.append(f"{last['rate']:.2f} m² a minute")
    if last["message"]:
        parts.append(last["message"])
    return ", ".join(parts)


def _number(value: float | None) -> float:
    return math.nan if value is None else value
