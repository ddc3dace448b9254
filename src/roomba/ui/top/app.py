"""The full-screen view: state, topics, map and log of a robot, and keys that command it."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Awaitable, Callable
from typing import Any, ClassVar, Final

from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widgets import DataTable, Footer, RichLog, Static

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.ui.state_words import lines_of
from roomba.ui.top.link import PageLink
from roomba.ui.top.map_text import LEGEND, map_text
from roomba.ui.top.rates import Rate, TopicRates
from roomba.vocabulary import HELD

_LOOK: Final = 0.25
"""s of wall time between two looks at what the link has."""
_RATES: Final = 2.0
"""s of wall time over which rates of topics are counted."""
_FORWARD, _TURN = 0.5, 0.3
"""Shares of the limits of speed and of turning at which keys drive."""
_MOST_LINES: Final = 500
"""Lines that the log keeps."""
_LINKS: Final = {
    "connecting": "connecting to the robot …",
    "gone": "the robot does not answer; this is what was seen last",
    "lost": "the connection was lost; trying again. This is what was seen last",
}


class TopApp(App[int]):
    """Shows a robot until the user leaves; a refused command is shown in the robot's sentence."""

    TITLE = "roomba top"
    CSS = """
    #left { width: 56; }
    #state { height: auto; min-height: 9; border: round $primary; padding: 0 1; }
    #topics { height: 1fr; border: round $primary; }
    #map { width: 1fr; height: 100%; border: round $primary; content-align: center middle; }
    #log { height: 8; border: round $primary; }
    .is-old { opacity: 50%; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("c", "clean", "clean"),
        Binding("p", "pause", "pause / go on"),
        Binding("d", "dock", "dock"),
        Binding("s", "stop", "stop"),
        Binding("space", "hold", "emergency stop / release"),
        Binding("l", "locate", "beep"),
        Binding("up", "drive(1, 0)", "drive", priority=True),
        Binding("down", "drive(-1, 0)", show=False, priority=True),
        Binding("left", "drive(0, 1)", show=False, priority=True),
        Binding("right", "drive(0, -1)", show=False, priority=True),
        Binding("q,ctrl+d", "leave", "leave"),
    ]
    ENABLE_COMMAND_PALETTE = False

    def __init__(self, link: PageLink, rates: TopicRates | None = None) -> None:
        """Show nothing yet; ``rates`` asks for the topics of a ROS graph, if there may be one."""
        super().__init__()
        self.link, self._rates = link, rates
        self._limits: dict[str, Any] = {}
        self._said: dict[str, str] = {}
        self._tasks: list[asyncio.Task[None]] = []
        link.on_refusal = self._tell_refusal
        self._state, self._map = Static(_LINKS["connecting"], id="state"), Static(id="map")
        self._topics: DataTable[str] = DataTable(id="topics", show_cursor=False)
        self._lines_told = RichLog(id="log", max_lines=_MOST_LINES, wrap=True)

    def compose(self) -> ComposeResult:
        """Lay out the panels."""
        with Horizontal():
            with Vertical(id="left"):
                yield self._state
                yield self._topics
            yield self._map
        yield self._lines_told
        yield Footer()

    def on_mount(self) -> None:
        """Begin to follow the robot."""
        self._state.border_title = "robot"
        self._map.border_title, self._map.border_subtitle = "map", LEGEND
        self._lines_told.border_title = "log"
        self._topics.border_title = "topics that are heard"
        self._topics.add_columns("topic", "1/s", "by")
        self._topics.can_focus = self._lines_told.can_focus = False
        self._topics.display = False
        self._tasks = [asyncio.create_task(self.link.run())]
        if self._rates is not None:
            self._tasks.append(asyncio.create_task(self._follow_rates(self._rates)))
        self.set_interval(_LOOK, self.look)

    async def on_unmount(self) -> None:
        """Let go of the robot; what it does goes on."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def look(self) -> None:
        """Show what the link has now."""
        link = self.link
        for each in (self._state, self._map):
            each.set_class(link.link != "live", "is-old")
        told = "\n".join(f"{name:<8} {value}" for name, value in self._lines())
        self._state.update(Text(told or _LINKS["connecting"]))
        if not link.state:
            return
        size = self._map.content_size
        self._map.update(map_text(link.grids, link.state, link.home, (size.width, size.height)))
        self._log_changes()

    def _lines(self) -> list[tuple[str, str]]:
        """Return lines about the robot, and about the connection where that has a problem."""
        link = self.link
        lines = lines_of(link.state) if "vacuum" in link.state else []
        if link.link != "live":
            reason = str(link.state.get("reason", ""))
            lines = [("link", _LINKS.get(link.link, link.link)), *lines]
            if link.link == "gone" and reason:
                lines.append(("because", reason))
        elif not link.may_change:
            lines.append(("keys", "only look: no token that fits"))
        return lines

    def _log_changes(self) -> None:
        """Write down what changed of state, troubles and errands."""
        told = self.link.state
        if "vacuum" not in told:
            return
        vacuum, last = told["vacuum"], told.get("last")
        does = [vacuum["state"], vacuum["phase"]]
        says = {
            "link": _LINKS.get(self.link.link, "connected"),
            "state": ", ".join(dict.fromkeys(each for each in does if each)),
            "room": f"in {vacuum['room']}" if vacuum["room"] else "",
            "trouble": vacuum["message"],
            "held": f"held: {told['held']}" if told["held"] else "",
            "place": told["doubt"],
            "ended": "" if last is None else f"{last['outcome']} {last['message']}".strip(),
        }
        for name, said in says.items():
            if said != self._said.get(name, ""):
                self._say(f"{name}: {said or 'all well again'}")
        self._said = says

    def _say(self, line: str) -> None:
        self._lines_told.write(f"{time.strftime('%H:%M:%S')}  {line}")

    def _tell_refusal(self, reason: str) -> None:
        self._say(f"refused: {reason}")

    async def _follow_rates(self, rates: TopicRates) -> None:
        """Show the rates of topics while there is a graph."""
        while True:
            self.show_rates(await asyncio.to_thread(rates.ask))
            await asyncio.sleep(_RATES)

    def show_rates(self, rates: list[Rate] | None) -> None:
        """Show rates of topics; None: there is no graph to ask."""
        self._topics.display = rates is not None
        self._topics.clear()
        for rate in rates or []:
            self._topics.add_row(rate.topic, f"{rate.rate:.1f}", str(rate.hearers))

    async def action_clean(self) -> None:
        """Clean the whole home."""
        await self._obeyed("clean", "clean: asked for the whole home")

    async def action_pause(self) -> None:
        """Let the robot stand, or go on if it waits for that."""
        is_held = self.link.state.get("vacuum", {}).get("state") in HELD
        await self._obeyed("resume" if is_held else "pause")

    async def action_dock(self) -> None:
        """Send the robot to its station."""
        await self._obeyed("dock")

    async def action_stop(self) -> None:
        """End what the robot does."""
        await self._obeyed("stop")

    async def action_locate(self) -> None:
        """Let the robot beep."""
        await self._obeyed("locate")

    async def action_hold(self) -> None:
        """Hold the drive until it is released, or release it."""
        if self.link.state.get("held"):
            await self._obeyed("release")
        else:
            await self._obeyed("emergency_stop", wish={"reason": "a key of ./roomba top"})

    async def action_drive(self, forward: int, left: int) -> None:
        """Drive by hand for half a second; a key that is held down repeats this."""

        async def drive() -> None:
            if not self._limits:
                self._limits = await self.link.limits()
            speed, turning = self._limits["max_speed"], self._limits["max_angular_speed"]
            turn = min(turning, math.tau) * _TURN * left
            await self.link.drive(_FORWARD * speed * forward, turn)

        await self._tried(drive)

    def action_leave(self) -> None:
        """Leave the robot to itself."""
        self.exit(0)

    async def _obeyed(self, name: str, told: str = "", wish: dict[str, Any] | None = None) -> None:
        if await self._tried(lambda: self.link.command(name, wish)):
            self._say(told or f"{name.replace('_', ' ')}: asked for")

    async def _tried(self, command: Callable[[], Awaitable[None]]) -> bool:
        """Return whether a command was passed on; show a refusal."""
        try:
            await command()
        except (RequestRefusedError, RobotUnavailableError) as refusal:
            self._tell_refusal(str(refusal))
            return False
        return True
