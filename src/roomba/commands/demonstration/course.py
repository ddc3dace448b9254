"""One demonstration from beginning to end: the steps, and the pictures taken meanwhile."""

from __future__ import annotations

import datetime as dt
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from roomba.commands.demonstration.listener import HeardMessage, Listener
from roomba.commands.demonstration.owner import Owner
from roomba.commands.demonstration.programs import RunningPrograms
from roomba.errors import RoombaError
from roomba.plots.canvas import Picture

LONGEST: Final = 4800.0
"""s of a whole demonstration: twice what one takes."""
_LOOK: Final = 0.5
"""s between two looks at what was told."""
_MOMENTS: Final = (6.0, 14.0)
"""m2 that are swept when the page is looked at."""
_PAUSED_AT: Final = 10.0
"""m2 that are swept when the smart home pauses the clean."""
_PAUSE: Final = 20.0
"""s until it lets it go on."""
_SETTLED: Final = 20.0
"""s after its end within which a run is kept, and all is told."""


@dataclass(frozen=True, slots=True)
class Shown:
    """A demonstrated robot: arguments that emulate it and drive it, and links of its lines."""

    emulate: tuple[str, ...]
    play: tuple[str, ...]
    links: tuple[str, ...]

    def filled(self, words: tuple[str, ...], folder: Path) -> list[str]:
        """Return arguments in which each link's name is replaced by its path in a folder."""
        return [str(folder / word) if word in self.links else word for word in words]


SHOWN: Final[Mapping[str, Shown]] = MappingProxyType(
    {
        "neato": Shown(
            ("neato", "--link", "neato_line"),
            ("--robot", "neato", "--line", "neato_line"),
            ("neato_line",),
        ),
        "create2": Shown(
            ("create2", "--serial", "--link", "create2_line", "--lidar-link", "ld19_line"),
            ("--robot", "create2", "--line", "create2_line", "--lidar-line", "ld19_line"),
            ("create2_line", "ld19_line"),
        ),
    }
)
"""By name; each line has its real speed: USB of a Neato, serial lines of a Create 2."""


@dataclass(slots=True)
class Seen:
    """What was seen: pictures of the page, messages of the broker, the run and its plan."""

    due: dt.datetime
    pages: list[Picture] = field(default_factory=list)
    report: Picture | None = None
    states: list[HeardMessage] = field(default_factory=list)
    maps: list[HeardMessage] = field(default_factory=list)
    said: list[HeardMessage] = field(default_factory=list)
    run: dict[str, Any] = field(default_factory=dict)
    notes: list[dict[str, Any]] = field(default_factory=list)


class Demonstration:
    """A robot cleans by its plan, and stands a while when the smart home says so."""

    def __init__(self, shown: Shown, folder: Path, tell: Callable[[str], object]) -> None:
        """Start nothing; all that programs keep comes into ``folder``."""
        self._shown, self._folder, self._tell = shown, folder, tell
        self._programs = RunningPrograms(folder)
        self._ends = time.monotonic() + LONGEST

    def run(self, home: str, seed: int) -> Seen:
        """Show it from beginning to end; raises RoombaError where something does not come."""
        try:
            listener, owner = self.begin(home, seed)
            try:
                return self._watch(listener, owner)
            finally:
                listener.end()
        finally:
            self.end()

    def begin(self, home: str, seed: int) -> tuple[Listener, Owner]:
        """Start broker, robot and brain; return who hears the robot, and who uses its page."""
        shown, folder = self._shown, self._folder
        port = self._programs.start_broker()
        robot = [*shown.filled(shown.emulate, folder), "--home", home, "--seed", str(seed)]
        self._programs.start_robot(robot, [folder / link for link in shown.links])
        settings = folder / "smart_home.yaml"
        settings.write_text(f"mqtt: {{host: 127.0.0.1, port: {port}}}\n", "utf-8")
        listener = Listener(port, "roomba/roomba")
        options = ("--smart-home", str(settings), "--port", "0", "--no-open")
        address = self._programs.start_brain([*shown.filled(shown.play, folder), *options])
        return listener, Owner(address)

    def end(self) -> None:
        """End all that was started."""
        self._programs.end()

    def _watch(self, listener: Listener, owner: Owner) -> Seen:
        self._await("the robot on its station", lambda: _does(listener, "docked"))
        seen = Seen(owner.plan_clean(dt.datetime.now(dt.timezone.utc)))
        self._tell(f"a plan is due at {seen.due:%H:%M} UTC")
        seen.pages.append(owner.look())
        self._await("the plan's clean to begin", lambda: _does(listener, "cleaning"))
        first, second = _MOMENTS
        self._look_at(first, listener, owner, seen)
        self._pause(listener)
        self._look_at(second, listener, owner, seen)
        self._await("the robot back on its station", lambda: _does(listener, "docked"))
        self._await("the run to be kept", lambda: owner.runs(), _SETTLED)
        seen.pages.append(owner.look())
        seen.run, seen.notes = owner.runs()[0], owner.notes()
        seen.report = owner.look_at_report(seen.run["number"])
        seen.states, seen.maps = listener.messages("state"), listener.messages("map")
        seen.said = listener.messages("command")
        return seen

    def _pause(self, listener: Listener) -> None:
        self._await_area(_PAUSED_AT, listener)
        listener.say("command", "pause")
        self._await("the pause", lambda: _does(listener, "paused"), _SETTLED)
        until = time.monotonic() + _PAUSE
        self._await("the end of the pause", lambda: time.monotonic() > until, 2.0 * _PAUSE)
        listener.say("command", "start")
        self._await("it to go on", lambda: _does(listener, "cleaning"), _SETTLED)

    def _look_at(self, area: float, listener: Listener, owner: Owner, seen: Seen) -> None:
        self._await_area(area, listener)
        seen.pages.append(owner.look())

    def _await_area(self, area: float, listener: Listener) -> None:
        self._await(f"{area:g} m2", lambda: (listener.state().get("area") or 0.0) >= area)

    def _await(self, what: str, is_so: Callable[[], object], longest: float | None = None) -> None:
        ends = self._ends if longest is None else min(self._ends, time.monotonic() + longest)
        while not is_so():
            if time.monotonic() > ends:
                raise RoombaError(f"expected {what}; it did not come in time")
            time.sleep(_LOOK)
        self._tell(what)


def _does(listener: Listener, state: str) -> bool:
    return bool(listener.state().get("state") == state)
