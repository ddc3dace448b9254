"""What the scheduler remembers from step to step, and over a restart: values, validated."""

from __future__ import annotations

import datetime as dt
from typing import Annotated, Final

from pydantic import Field

from roomba.configuration.frozen import Count, Frozen
from roomba.plans.moment import Moment

MOST_NOTES: Final = 60
"""Notes that are kept, the newest."""


class Waiting(Frozen):
    """A time of a plan that is due, and has not been cleaned yet.

    ``reason`` says why, empty at first; it is not tried again before ``not_before``.
    """

    due: Moment
    not_before: Moment
    tries: Count = 0
    reason: str = ""


class Running(Frozen):
    """A clean that a plan began. ``held`` is since when it is paused for a person at home."""

    plan: str
    due: Moment
    began: Moment
    tries: Count = 0
    held: Moment | None = None
    is_overruled: bool = False
    """A person let it go on: it is not paused any more for quiet hours or a person at home."""
    is_left_to_people: bool = False
    """The emergency stop was pressed: people alone decide on it, also if it is tried again."""
    rests_since: Moment | None = None
    """Since when the robot stands without telling how the clean ended."""
    unanswered: str = ""
    """Why it is unknown whether it began, as the robot was asked and silent; empty if known."""

    def not_after(self, now: dt.datetime) -> Running:
        """Return the clean with its moments, but none later than ``now``."""
        moments = {name: getattr(self, name) for name in ("due", "began", "held", "rests_since")}
        return self.model_copy(
            update={name: min(at, now) for name, at in moments.items() if at is not None}
        )


class Note(Frozen):
    """What became of a plan."""

    at: Moment
    plan: str
    text: str


class Memory(Frozen):
    """What is remembered: ``seen`` is when the last step was, ``waiting`` is by plans' names."""

    seen: Moment | None = None
    since: dict[str, Moment] = Field(default={})
    """Of each plan: its times up to here were dealt with."""
    next_at: dict[str, Moment] = Field(default={})
    """Of each plan that has a further time: when that is."""
    reckoned: dict[str, str] = Field(default={})
    """Of each plan: its days, times and zone as a text, by which ``next_at`` was reckoned."""
    waiting: dict[str, Waiting] = Field(default={})
    running: Running | None = None
    notes: Annotated[tuple[Note, ...], Field(max_length=MOST_NOTES)] = ()

    def noting(self, note: Note) -> Memory:
        """Return the memory with a note more, and without the oldest ones."""
        return self.model_copy(update={"notes": (*self.notes, note)[-MOST_NOTES:]})

    def forgetting(self, plan: str) -> Memory:
        """Return the memory without what is remembered of a plan but its notes."""
        update = {
            name: {other: value for other, value in getattr(self, name).items() if other != plan}
            for name in ("since", "next_at", "waiting")
        }
        return self.model_copy(update=update)

    def not_ahead(self, now: dt.datetime, longest: dt.timedelta) -> Memory:
        """Return the memory without moments to come, which a clock that was ahead has noted.

        What began is no later than now, and what waits is tried again within ``longest``.
        """
        waiting = {
            name: waits.model_copy(
                update={
                    "due": min(waits.due, now),
                    "not_before": min(waits.not_before, now + longest),
                }
            )
            for name, waits in self.waiting.items()
        }
        running = None if self.running is None else self.running.not_after(now)
        return self.model_copy(update={"waiting": waiting, "running": running})

    def replanned(self) -> Memory:
        """Return the memory without what was reckoned of plans' times, which were changed."""
        return self.model_copy(update={"since": {}, "next_at": {}, "reckoned": {}})

    def without_waiting(self, plan: str) -> Memory:
        """Return the memory in which nothing waits of a plan."""
        waiting = {name: value for name, value in self.waiting.items() if name != plan}
        return self.model_copy(update={"waiting": waiting})

    def with_waiting(self, plan: str, waits: Waiting) -> Memory:
        """Return the memory in which a time of a plan waits."""
        return self.model_copy(update={"waiting": {**self.waiting, plan: waits}})
