"""Samples the robot's state during a run of ``sim``, for the history."""

from __future__ import annotations

import math
from typing import Final

from roomba.headless.live.views import home_view, vacuum_snapshot
from roomba.headless.mission import HeadlessMission
from roomba.history.run import Word

_STEP: Final = 2.0
"""s of the robot's clock between two looks at its state."""


class StateSamples:
    """Looks at the robot's state now and then while it cleans."""

    def __init__(self) -> None:
        """Begin before the run."""
        self.rows: list[tuple[float, ...]] = []
        self.words: list[Word] = []
        self._robot: HeadlessMission | None = None
        self._due, self._phase = -math.inf, ""

    def __call__(self, robot: HeadlessMission) -> None:
        """Look, if it is time to."""
        phase = robot.mission.state.phase.value
        if robot.seen.time < self._due and phase == self._phase:
            return
        self._due, self._phase = robot.seen.time + _STEP, phase
        snapshot, seen, now = vacuum_snapshot(robot), robot.seen, robot.seen.time
        self.rows.append(
            (
                now,
                abs(seen.odometry_twist.linear),
                seen.battery.level,
                seen.in_bin,
                snapshot.covered,
                snapshot.wanted,
                snapshot.seconds_to_go,
                float(robot.mission.sweeps),
            )
        )
        hindrance = snapshot.hindrance.value
        word = Word(
            now, snapshot.state, phase, snapshot.message, snapshot.room, hindrance=hindrance
        )
        if not self.words or not word.is_as(self.words[-1]):
            self.words.append(word)
        self._robot = robot

    @property
    def home(self) -> dict[str, object]:
        """The home as the robot knows it, in a page's form; empty before the first sample."""
        if self._robot is None:
            return {}
        # Imported here: a run should begin at once, and needs no camera.
        from roomba.client.plain import home_of
        from roomba.headless.live.playing import Playing

        context = self._robot.mission.context
        home = Playing(self._robot.simulator.home, self._robot)
        view = home_view(1, home, self._robot, context.rooms, context.zones)
        return home_of(view)
