"""A table of a clean as told by MQTT: a new row whenever the robot began to do something else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final

from roomba.commands.demonstration.listener import HeardMessage

_HEAD: Final = "| min:s | told | battery | area |\n|---|---|---|---|"
_NOTHING: Final = "none"
"""Where nothing is wrong."""
_EACH: Final = 5.0
"""m2 after which a row is due while nothing else changes."""


def table_of(states: Sequence[HeardMessage], said: Sequence[HeardMessage], due: float) -> str:
    """Return Markdown of the states that were told and the commands that were said, by time.

    Times are those since the plan was due.
    """
    moments = sorted([*_changes(states), *((each, None) for each in said)], key=_time)
    rows = [
        _command(each, due) if told is None else _row(each, told, due) for each, told in moments
    ]
    return "\n".join([_HEAD, *rows]) + "\n"


def _time(moment: tuple[HeardMessage, dict[str, Any] | None]) -> float:
    return moment[0].time


def _changes(states: Sequence[HeardMessage]) -> list[tuple[HeardMessage, dict[str, Any]]]:
    found: list[tuple[HeardMessage, dict[str, Any]]] = []
    for message in states:
        told = message.values()
        before = found[-1][1] if found else None
        if before is None or _does(told) != _does(before) or _grew(told, before):
            found.append((message, told))
    if states and found[-1][0] is not states[-1]:
        found.append((states[-1], states[-1].values()))
    return found


def troubles_of(states: Sequence[HeardMessage]) -> str:
    """Return Markdown of what was told to be wrong: how often, and for how many s in all."""
    times: Counter[str] = Counter()
    seconds: Counter[str] = Counter()
    before = _NOTHING
    for message, following in pairwise(states):
        error = message.values()["error"]
        times[error] += error != before
        seconds[error] += round(following.time - message.time)
        before = error
    rows = [
        f"- “{error}”: {times[error]} times, {seconds[error]} s in all"
        for error in times
        if error != _NOTHING
    ]
    return "".join(f"{row}\n" for row in rows)


def _does(told: dict[str, Any]) -> tuple[str, str]:
    return told["state"], told["phase"]


def _grew(told: dict[str, Any], before: dict[str, Any]) -> bool:
    return (told["area"] or 0.0) // _EACH > (before["area"] or 0.0) // _EACH


def _row(message: HeardMessage, told: dict[str, Any], due: float) -> str:
    state, phase = _does(told)
    words = state if phase == state else f"{state} ({phase})"
    area = "" if told["area"] is None else f"{told['area']:.1f} m²"
    return f"| {_clock(message.time - due)} | {words} | {told['battery']:.0f} % | {area} |"


def _command(message: HeardMessage, due: float) -> str:
    topic = message.topic.rpartition("/")[2]
    return f"| {_clock(message.time - due)} | → `{topic}`: `{message.payload.decode()}` | | |"


def _clock(seconds: float) -> str:
    whole = round(abs(seconds))
    return f"{'−' if seconds < 0.0 and whole else ''}{whole // 60}:{whole % 60:02d}"
