"""A robot without ROS for tests and demos: it follows a script, so runs repeat exactly.

It drives straight lines at its top speed. What may go wrong on a walk is written in a
:class:`WalkScript`. Its time is a :class:`SteppedClock`, which passes only while a caller waits, or
the module ``time`` for a run in real time.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from roomba.client.clock import Clock
from roomba.client.fake.errands import ErrandScript
from roomba.client.fake.vacuum import FakeVacuum
from roomba.client.protocol import (
    Limits,
    RequestRefusedError,
    RobotState,
    RobotUnavailableError,
    WalkOutcome,
    WalkReport,
)

CAMERA_ANGLES = (-30.0, -15.0, 0.0, 15.0, 30.0)
"""Degrees for which there is a picture."""

SEED_LIMITS = Limits(low=-100.0, high=100.0, max_speed=0.5)

VANISHED_NOTICE = 1.0
"""s from the end of the action server to the client's report of it (at most 1 s is promised)."""

_INSTANT = 1e-9
"""s; two sums of the same waits may differ by rounding."""


class SteppedClock:
    """Time that passes only while a caller waits; ``events`` are (s, what happens then)."""

    def __init__(self, events: Iterable[tuple[float, Callable[[], None]]] = ()) -> None:
        self._now = 0.0
        self._events = sorted(events, key=lambda event: event[0])

    def monotonic(self) -> float:
        """Return how many seconds have been waited."""
        return self._now

    def sleep(self, seconds: float, /) -> None:
        """Advance the time, and let each event happen at its moment."""
        end = self._now + seconds
        while self._events and self._events[0][0] <= end:
            moment, happen = self._events.pop(0)
            self._now = max(self._now, moment)
            happen()
        self._now = max(self._now, end)


class Turn(Enum):
    """How a scripted walk ends."""

    ARRIVES = "arrives"
    ABSENT = "absent"
    """No action server answers: the walk cannot be asked for."""
    REFUSED = "refused"
    FAILS = "fails"
    """The robot gives up on the way."""
    VANISHES = "vanishes"
    """The action server ends on the way, and the client notices."""
    FREEZES = "freezes"
    """The whole robot stops answering on the way, and no report comes."""


@dataclass(frozen=True, slots=True)
class WalkScript:
    """One walk: its ``turn`` comes ``after`` s, unless it has arrived by then.

    A robot that does not ``obey`` a cancellation walks on.
    """

    turn: Turn = Turn.ARRIVES
    after: float = 0.0
    message: str = ""
    obeys: bool = True


class FakeRobot(FakeVacuum):
    """A :class:`roomba.client.protocol.RobotClient` and
    :class:`roomba.client.protocol.CameraClient` in one.

    ``scripts`` are used up one per walk, later walks arrive; ``detour`` is path over straight
    distance; ``blocked`` maps points to the reason why there is no way to them; ``answers`` and
    ``camera_answers`` may be set at any time. Walks and errands (``room_names``, ``errands`` and
    ``battery``, see :class:`FakeVacuum`) know nothing of each other.
    """

    def __init__(
        self,
        *,
        limits: Limits = SEED_LIMITS,
        station: tuple[float, float] = (0.0, 0.0),
        position: tuple[float, float] = (0.0, 0.0),
        dirt: float = 0.25,
        doubt: str = "",
        detour: float = 1.0,
        blocked: Mapping[tuple[float, float], str] | None = None,
        scripts: Iterable[WalkScript] = (),
        clock: Clock | None = None,
        picture_shape: tuple[int, int] = (768, 1024),
        room_names: Sequence[str] = ("kitchen", "hall", "study"),
        errands: Iterable[ErrandScript] = (),
        battery: float = 0.8,
    ) -> None:
        super().__init__(SteppedClock() if clock is None else clock, room_names, errands, battery)
        self.camera_answers = True
        self.walks: list[FakeWalk] = []
        self._limits = limits
        self._station = station
        self._position = position
        self._dirt, self._doubt = dirt, doubt
        self._detour = detour
        self._blocked = dict(blocked or {})
        self._walk_scripts = list(scripts)
        self._picture_shape = picture_shape

    def limits(self) -> Limits:
        """Return the limits it was made with."""
        return self._limits

    def station(self) -> tuple[float, float]:
        """Return the station it was made with."""
        return self._station

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return where it is now; a silent robot uses up the ``timeout`` and raises."""
        walk = self.walks[-1] if self.walks else None
        if not self.answers or (walk is not None and walk.frozen):
            self.clock.sleep(timeout)
            raise RobotUnavailableError(f"expected a position within {timeout:g} s, none came")
        x, y = self._position if walk is None else walk.position
        speed = 0.0 if walk is None else walk.speed
        return RobotState(x=x, y=y, speed=speed, dirt=self._dirt, doubt=self._doubt)

    def path_length(self, x: float, y: float) -> float:
        """Return the straight distance times ``detour``; refuses what is blocked or outside."""
        low, high = self._limits.low, self._limits.high
        if not all(low <= value <= high for value in (x, y)):
            raise RequestRefusedError(
                f"expected coordinates from {low:g} to {high:g} m, got ({x:g}, {y:g})"
            )
        if (x, y) in self._blocked:
            raise RequestRefusedError(self._blocked[x, y])
        state = self.state()
        return self._detour * math.hypot(x - state.x, y - state.y)

    def walk_to(self, x: float, y: float) -> FakeWalk:
        """Start the next scripted walk; a walk under way ends as cancelled."""
        script = self._walk_scripts.pop(0) if self._walk_scripts else WalkScript()
        if not self.answers or script.turn is Turn.ABSENT:
            self.clock.sleep(5.0)
            raise RobotUnavailableError(
                script.message or "no action server answers; is it launched?"
            )
        length = self.path_length(x, y)
        state = self.state()
        if self.walks:
            self.walks[-1].preempt()
        walk = FakeWalk(
            script, self.clock, (state.x, state.y), (x, y), length, self._limits.max_speed
        )
        self.walks.append(walk)
        return walk

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return a coloured gradient, another one for each of :data:`CAMERA_ANGLES`."""
        if not self.camera_answers:
            self.clock.sleep(5.0)
            raise RobotUnavailableError("no camera service answered within 5 s; is it launched?")
        if not abs(degrees) <= 360.0:
            raise RequestRefusedError(
                f"expected an angle from -360 to 360 degrees, got {degrees:g}"
            )
        index = min(range(len(CAMERA_ANGLES)), key=lambda i: abs(CAMERA_ANGLES[i] - degrees))
        height, width = self._picture_shape
        picture = np.empty((height, width, 3), dtype=np.uint8)
        picture[..., 0] = 50 * index
        picture[..., 1] = np.linspace(0, 255, height).astype(np.uint8)[:, np.newaxis]
        picture[..., 2] = np.linspace(0, 255, width).astype(np.uint8)
        return picture


class FakeWalk:
    """A :class:`roomba.client.protocol.WalkHandle` whose state follows from its script and the
    clock alone."""

    def __init__(
        self,
        script: WalkScript,
        clock: Clock,
        start: tuple[float, float],
        destination: tuple[float, float],
        length: float,
        speed: float,
    ) -> None:
        self.cancels = 0
        """How often it was asked to stop."""
        self._script = script
        self._clock = clock
        self._start = start
        self._destination = destination
        self._length = length
        self._cruise_speed = speed
        self._began = clock.monotonic()
        self._arrival = length / speed
        self._stopped_at = math.inf
        self._feedbacks = 0

    def next_feedback(self, timeout: float) -> float | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        if self.report() is not None:
            return None
        due = min(self._feedbacks * self._interval, self._end)
        if self._muted(due) or due - self._elapsed > timeout:
            self._clock.sleep(min(timeout, max(0.0, self._end - self._elapsed)))
            return None
        self._clock.sleep(max(0.0, due - self._elapsed))
        if self.report() is not None:
            return None
        self._feedbacks += 1
        return self._length - self._travelled

    def report(self) -> WalkReport | None:
        """Return the scripted end once its time has come."""
        if self._elapsed < self._end - _INSTANT:
            return None
        outcome = self._outcome
        message = self._script.message if outcome is not WalkOutcome.ARRIVED else ""
        return WalkReport(
            outcome=outcome, distance=self._travelled, duration=self._end, message=message
        )

    def cancel(self) -> None:
        """Stop on the spot, unless the script says that the robot does not listen."""
        self.cancels += 1
        if self._script.obeys and not self._muted(self._elapsed):
            self.preempt()

    def preempt(self) -> None:
        """Stop on the spot, also against the script: another walk takes over."""
        self._stopped_at = min(self._stopped_at, self._elapsed)

    @property
    def position(self) -> tuple[float, float]:
        """Where the robot is now, on the straight line to its destination, m."""
        part = self._travelled / self._length if self._length > 0.0 else 1.0
        (x, y), (goal_x, goal_y) = self._start, self._destination
        return x + part * (goal_x - x), y + part * (goal_y - y)

    @property
    def speed(self) -> float:
        """How fast it goes now, m/s."""
        return self._cruise_speed if self._elapsed < self._halt - _INSTANT else 0.0

    @property
    def frozen(self) -> bool:
        """Whether the whole robot has stopped answering."""
        return self._script.turn is Turn.FREEZES and self._muted(self._elapsed)

    @property
    def _elapsed(self) -> float:
        return self._clock.monotonic() - self._began

    @property
    def _interval(self) -> float:
        """Seconds between feedbacks, as the original: by how long the walk takes."""
        return 2.0 if self._arrival < 10.0 else 3.0 if self._arrival < 20.0 else 4.0

    @property
    def _turning_point(self) -> float:
        """When the script strikes, s into the walk; never, if the robot arrives before."""
        if self._script.turn is Turn.REFUSED:
            return 0.0
        strikes = self._script.turn in (Turn.FAILS, Turn.VANISHES, Turn.FREEZES)
        return self._script.after if strikes and self._script.after < self._arrival else math.inf

    @property
    def _halt(self) -> float:
        """When the robot stands still, s into the walk."""
        return min(self._arrival, self._turning_point, self._stopped_at)

    @property
    def _end(self) -> float:
        """When the client can report the end, s into the walk."""
        if self._halt < self._turning_point:
            return self._halt
        late = {Turn.VANISHES: VANISHED_NOTICE, Turn.FREEZES: math.inf}
        return self._turning_point + late.get(self._script.turn, 0.0)

    @property
    def _outcome(self) -> WalkOutcome:
        if self._stopped_at < min(self._arrival, self._turning_point):
            return WalkOutcome.CANCELLED
        if math.isinf(self._turning_point):
            return WalkOutcome.ARRIVED
        return {
            Turn.REFUSED: WalkOutcome.REFUSED,
            Turn.FAILS: WalkOutcome.FAILED,
        }.get(self._script.turn, WalkOutcome.DISCONNECTED)

    @property
    def _travelled(self) -> float:
        return min(self._length, self._cruise_speed * min(self._elapsed, self._halt))

    def _muted(self, elapsed: float) -> bool:
        """Whether the server neither reports nor listens any more, ``elapsed`` s into the walk."""
        gone = self._script.turn in (Turn.VANISHES, Turn.FREEZES)
        return gone and elapsed >= self._turning_point - _INSTANT


REAL_TIME: Clock = time
"""For demos and for tests of a whole process."""
