"""Follows a walk to its end, and shows how far it is.

On a terminal it shows a live bar of rich, elsewhere (a pipe, a dumb terminal) one plain line for
each feedback.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator
from typing import Any, Protocol

from rich.console import Console
from rich.progress import Progress

from roomba.client.clock import Clock
from roomba.client.protocol import RobotClient, RobotState, WalkHandle, WalkOutcome, WalkReport
from roomba.errors import RoombaError
from roomba.ui.live_bar import live_bar

POLL_TIME = 0.25
"""s between two looks at a walk: Ctrl-C is noticed after that time at the latest."""

STATE_TIMEOUT = 0.2
"""s to wait for a state while walking; without one the speed is told as unknown."""

SILENCE_LIMIT = 6.0
"""s without feedback and movement until a walk is disconnected; feedback is due every 4 s."""

CANCEL_DEADLINE = 5.0
"""s that a robot has to confirm a cancellation; it should need 0.5 s."""

LEAST_MOVEMENT = 0.01
"""m; a smaller change of position may be noise and is no sign of life."""


def quantity(value: float, unit: str, decimals: int = 2) -> str:
    """Return a number for people with its unit; what is no finite number is ``unknown``."""
    if not math.isfinite(value):
        return "unknown"
    # adding 0.0 turns the -0.0 that rounding leaves into 0.0
    return f"{round(value, decimals) + 0.0:.{decimals}f} {unit}"


def say(console: Console, text: str, style: str | None = None) -> None:
    """Print text as it is: no markup in a robot's message, no line broken at column 80."""
    console.print(text, style=style, markup=False, emoji=False, highlight=False, soft_wrap=True)


class WalkView(Protocol):
    """Somewhere to show a walk."""

    def feedback(self, left: float, speed: float) -> None:
        """Show the path distance left, m, and the current speed, m/s; NaN if unknown."""

    def speed(self, speed: float) -> None:
        """Show a newer speed, m/s, between two feedbacks."""

    def arrived(self) -> None:
        """Show that nothing is left."""


class LineView:
    """One plain line per feedback."""

    def __init__(self, console: Console) -> None:
        self._console = console

    def feedback(self, left: float, speed: float) -> None:
        """Print a line."""
        distance, pace = quantity(left, "m"), quantity(speed, "m/s")
        say(self._console, f"Distance left: {distance}, current speed: {pace}")

    def speed(self, speed: float) -> None:
        """Leave it to the next line."""

    def arrived(self) -> None:
        """Leave it to the report."""


class LiveView(LineView):
    """A line for each feedback, and below them a bar that is redrawn when something is new."""

    def __init__(self, progress: Progress, total: float) -> None:
        super().__init__(progress.console)
        self._progress = progress
        self._total = max(total, 1e-6)
        self._task = progress.add_task(
            "Walking", total=self._total, left=_left(total), pace=_pace(0.0)
        )

    def feedback(self, left: float, speed: float) -> None:
        """Print a line and move the bar; a detour may leave more distance than at first."""
        super().feedback(left, speed)
        self._update(
            completed=self._total - left,  # rich draws a negative share as an empty bar
            left=_left(left),
            pace=_pace(speed),
        )

    def speed(self, speed: float) -> None:
        """Show a newer speed, if it reads differently."""
        pace = _pace(speed)
        if pace != self._progress.tasks[self._task].fields["pace"]:
            self._update(pace=pace)

    def arrived(self) -> None:
        """Fill the bar."""
        self._update(completed=self._total, left=_left(0.0), pace=_pace(0.0))

    def _update(self, completed: float | None = None, **fields: Any) -> None:
        self._progress.update(self._task, completed=completed, refresh=True, **fields)


def _left(distance: float) -> str:
    return f"{quantity(distance, 'm')} left"


def _pace(speed: float) -> str:
    return f"at {quantity(speed, 'm/s')}"


@contextlib.contextmanager
def walk_view(console: Console, total: float) -> Iterator[WalkView]:
    """Give a view for a walk of ``total`` m: live on a terminal, plain lines anywhere else."""
    if not console.is_interactive:
        yield LineView(console)
        return
    with live_bar(console, ("left", "pace")) as progress:
        yield LiveView(progress, total)


def follow_walk(
    walk: WalkHandle,
    robot: RobotClient,
    view: WalkView,
    *,
    total: float,
    wants_to_stop: Callable[[], bool],
    clock: Clock = time,
) -> WalkReport:
    """Show a walk of ``total`` m until it ends; returns after a finite time in any case.

    ``wants_to_stop`` is asked every :data:`POLL_TIME`; once true, the walk is cancelled. A robot
    that neither reports nor moves for :data:`SILENCE_LIMIT`, or does not confirm a cancellation
    within :data:`CANCEL_DEADLINE`, counts as disconnected.
    """
    signs_of_life = _SignsOfLife(total, clock)
    cancelled = math.inf
    while (report := walk.report()) is None:
        now = clock.monotonic()
        if math.isinf(cancelled) and wants_to_stop():
            _cancel(walk)
            cancelled = now
        if now - cancelled >= CANCEL_DEADLINE:
            return signs_of_life.disconnected(
                f"it did not confirm within {CANCEL_DEADLINE:g} s that it stops"
            )
        if signs_of_life.silence >= SILENCE_LIMIT:
            _cancel(walk)  # the robot may answer again later: then it must not walk on unseen
            return signs_of_life.disconnected(f"it has not answered for {SILENCE_LIMIT:g} s")
        left = walk.next_feedback(POLL_TIME)
        state = _newest_state(robot)
        speed = math.nan if state is None else state.speed
        signs_of_life.note(left, state)
        if left is not None:
            view.feedback(left, speed)
            continue
        view.speed(speed)
        if walk.report() is None:
            # a client may know of the end a moment before it can report it
            clock.sleep(max(0.0, now + POLL_TIME - clock.monotonic()))
    if report.outcome is WalkOutcome.ARRIVED:
        view.arrived()
    return report


class _SignsOfLife:
    """When the robot was last seen alive, and how far it was then."""

    def __init__(self, total: float, clock: Clock) -> None:
        self._clock = clock
        self._total = total
        self._left = total
        self._began = self._seen = clock.monotonic()
        self._place: tuple[float, float] | None = None

    @property
    def silence(self) -> float:
        """Seconds without any sign of life."""
        return self._clock.monotonic() - self._seen

    def note(self, left: float | None, state: RobotState | None) -> None:
        """Take in what was heard: a feedback or a movement is a sign of life."""
        moved = state is not None and (
            self._place is None or math.dist(self._place, (state.x, state.y)) >= LEAST_MOVEMENT
        )
        if state is not None and moved:
            self._place = (state.x, state.y)
        if left is not None:
            self._left = left
        if moved or left is not None:
            self._seen = self._clock.monotonic()

    def disconnected(self, message: str) -> WalkReport:
        """Return the report of a walk whose robot is silent."""
        return WalkReport(
            outcome=WalkOutcome.DISCONNECTED,
            distance=max(0.0, self._total - self._left),
            duration=self._clock.monotonic() - self._began,
            message=message,
        )


def _newest_state(robot: RobotClient) -> RobotState | None:
    try:
        return robot.state(timeout=STATE_TIMEOUT)
    except RoombaError:
        return None


def _cancel(walk: WalkHandle) -> None:
    # a robot that gets no cancel does not confirm it: the deadline notices
    with contextlib.suppress(RoombaError):
        walk.cancel()
