"""The report's menu: four options by number, and room for more below.

Speaks to :mod:`roomba.client.protocol` alone, and decides nothing: distances, reasons and reports
are the robot's.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rich.console import Console

from roomba.client.clock import Clock
from roomba.client.protocol import (
    RobotClient,
    RobotUnavailableError,
    WalkOutcome,
    WalkReport,
)
from roomba.errors import RoombaError
from roomba.ui.progress import follow_walk, quantity, say, walk_view
from roomba.ui.prompt import (
    STATUS_DONE,
    STATUS_INTERRUPTED,
    EndOfInputError,
    Interrupts,
    Keyboard,
    Read,
    ask,
    explain,
    read_number,
)

ALREADY_THERE = 0.05
"""m; a destination this close is where the robot is."""


@dataclass(frozen=True, slots=True)
class Option:
    """A line of the menu and the function that it calls."""

    label: str
    act: Callable[[Menu], None]


class Menu:
    """The menu on a console; ``read`` asks as ``input`` does, ``options`` are numbered from 1.

    The options ``more`` follow below, under ``more_heading``; the numbers continue.
    """

    def __init__(
        self,
        robot: RobotClient,
        read: Read | None = None,
        console: Console | None = None,
        *,
        options: Sequence[Option] | None = None,
        more: Sequence[Option] = (),
        more_heading: str = "for more",
        clock: Clock = time,
    ) -> None:
        self.robot = robot
        self.console = Console() if console is None else console
        self.clock = clock
        self.interrupts = Interrupts()
        self._read = Keyboard() if read is None else read
        self._first = OPTIONS if options is None else tuple(options)
        self._options = (*self._first, *more)
        self._more_heading = more_heading

    def run(self) -> int:
        """Ask and act until the end of input (status 0) or Ctrl-C (status 130)."""
        with self.interrupts:
            try:
                while True:
                    self._show_options()
                    option = self._choose()
                    try:
                        option.act(self)
                    except RoombaError as error:
                        self.say(explain(error), style="red")
            except EndOfInputError:
                self.say("")
                return STATUS_DONE
            except KeyboardInterrupt:
                self.say("")
                return STATUS_INTERRUPTED

    def say(self, text: str, style: str | None = None) -> None:
        """Print a line for the user, exactly as it is."""
        say(self.console, text, style)

    def ask(self, prompt: str) -> str:
        """Return an answer without the blanks around it; EndOfInputError when there is none."""
        return ask(self._read, prompt)

    def key_of(self, act: Callable[[Menu], None]) -> str:
        """Return the number to press for the option that calls ``act``."""
        return str([option.act for option in self._options].index(act) + 1)

    def tell_dirt(self) -> None:
        """Tell the dirt under the robot."""
        self.say(f"Current dirt amount: {quantity(self.robot.state().dirt, 'g')} under the robot")

    def tell_position(self) -> None:
        """Tell where the robot is."""
        state = self.robot.state()
        self.say(f"Current position: {place(state.x, state.y)}")
        if state.doubt:
            self.say(f"The robot is not sure of that: {state.doubt}", style="yellow")

    def go_to_destination(self) -> None:
        """Ask for a destination and walk there."""
        x = self._ask_coordinate(" X is equal to ")
        y = self._ask_coordinate(" Y is equal to ")
        self._walk(x, y, "at the destination")

    def go_to_station(self) -> None:
        """Walk to the charging station."""
        x, y = self.robot.station()
        self._walk(x, y, "at its charging station")

    def _show_options(self) -> None:
        first, last = len(self._first), len(self._options)
        self.say("")
        self.say(f"Please press {_keys(1, first)} to choose what the robot does:", style="bold")
        for number, option in enumerate(self._options, start=1):
            if number == first + 1:
                self.say(f"Or press {_keys(number, last)} {self._more_heading}:", style="bold")
            self.say(f"  {number}. {option.label}")

    def _choose(self) -> Option:
        table = {str(number): option for number, option in enumerate(self._options, start=1)}
        while (option := table.get(self.ask("Select: "))) is None:
            self.say("Please choose a valid number", style="red")
        return option

    def _ask_coordinate(self, prompt: str) -> float:
        while True:
            text = self.ask(prompt)
            number = read_number(text)
            limits = self.robot.limits()  # read each time: the limits may change
            if number is not None and limits.low <= number <= limits.high:
                return number
            expected = f"a number from {limits.low:g} to {limits.high:g} (metres)"
            self.say(f"Expected {expected}, got {text!a}. Please try again.", style="red")

    def _walk(self, x: float, y: float, there: str) -> None:
        state = self.robot.state()
        if math.dist((state.x, state.y), (x, y)) <= ALREADY_THERE:
            self.say(f"The robot is already {there}: {place(state.x, state.y)}")
            return
        with self.interrupts.held():
            length = self.robot.path_length(x, y)
            speed = self.robot.limits().max_speed
            expected = length / speed if speed > 0.0 else math.nan
            self.say(f"Distance: {quantity(length, 'm')}")
            self.say(f"Expected time: {quantity(expected, 's', 1)}")
            if self.interrupts.noted():
                self.say("Cancelled before the robot set out.")
                return
            report = self._supervise(x, y, length)
        self._tell_end(report)

    def _supervise(self, x: float, y: float, length: float) -> WalkReport:
        walk = self.robot.walk_to(x, y)
        try:
            with walk_view(self.console, length) as view:
                return follow_walk(
                    walk,
                    self.robot,
                    view,
                    total=length,
                    wants_to_stop=self.interrupts.noted,
                    clock=self.clock,
                )
        except BaseException:
            # however the menu ends here, the robot must not walk on unseen
            with contextlib.suppress(RoombaError):
                walk.cancel()
            raise

    def _tell_end(self, report: WalkReport) -> None:
        reason = " ".join(report.message.split()) or "no reason given"
        travelled, took = quantity(report.distance, "m"), quantity(report.duration, "s", 1)
        if report.outcome is WalkOutcome.REFUSED:
            self.say(f"The robot refuses: {reason}", style="red")
        elif report.outcome is WalkOutcome.FAILED:
            self.say(f"The robot gave up after {travelled} and {took}: {reason}", style="red")
        elif report.outcome is WalkOutcome.DISCONNECTED:
            self.say(f"The robot was lost after {travelled} and {took}: {reason}", style="red")
        else:
            arrived = report.outcome is WalkOutcome.ARRIVED
            # another program's goal may have replaced the walk: then the message says so
            why = f": {reason}" if report.message else "."
            self.say("The robot has arrived." if arrived else f"The walk was cancelled{why}")
            self.say(f"Position reached: {self._position()}")
            self.say(f"Distance travelled: {travelled}")
            self.say(f"Time taken: {took}")

    def _position(self) -> str:
        try:
            state = self.robot.state(timeout=1.0)
        except RobotUnavailableError:
            return "unknown"
        return place(state.x, state.y)


def _keys(first: int, last: int) -> str:
    return str(first) if first == last else f"{first}-{last}"


def place(x: float, y: float) -> str:
    """Return a place for people."""
    return f"x = {quantity(x, 'm')}, y = {quantity(y, 'm')}"


OPTIONS: tuple[Option, ...] = (
    Option("Current dirt amount", Menu.tell_dirt),
    Option("Current position", Menu.tell_position),
    Option("Traverse to a specified destination", Menu.go_to_destination),
    Option("Return to the charging station", Menu.go_to_station),
)
"""The report's menu; a new option is a new line here."""
