"""The simulated world: one robot in one home, a step at a time.

Seeded: the same home, configuration, seed and commands give the same trace, bit for bit.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.config import RobotConfig
from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.world import dirt_kernels
from roomba.world.body import Body, Bumper
from roomba.world.dirt import MICROGRAMS_PER_GRAM, DirtField
from roomba.world.home import DirtSource, Home

_CRUMB = 0.002
"""g; what falls at once from a source that sheds dirt."""
_SECONDS_PER_HOUR = 3600.0
_TRIES = 64
"""How often a place on the floor is looked for before a crumb counts as fallen on the furniture."""


@dataclass(frozen=True, slots=True)
class Observation:
    """What is so after a step: the truth, and what the robot's sensors tell of it.

    ``odometry`` is the pose in the frame that the robot started in; ``dirt_under`` is g under the
    body's disc, ``in_bin`` g in the bin.
    """

    time: float
    pose: Pose
    odometry: Pose
    twist: Twist
    bumper: Bumper
    dirt_under: float
    in_bin: float


class Simulator:
    """A robot in its home; :meth:`step` is the only thing that lets time pass."""

    def __init__(
        self,
        home: Home,
        config: RobotConfig | None = None,
        *,
        seed: int = 0,
        max_speed: float = 0.5,
        start: Pose | None = None,
    ) -> None:
        """Put the robot at ``start``, map frame (the station, if none), and the home's dirt down.

        Raises HomeError when the body does not fit at the start.
        """
        self.home = home
        self.config = config or RobotConfig()
        self.time = 0.0
        self.start = start or home.station
        self.body = Body(
            home.solid, home.frame, self.config.body, max_speed=max_speed, start=self.start
        )
        if self.body.gap < 0.0:
            raise HomeError(
                f"home {home.name}: the robot does not fit at ({self.start.x:.2f}, "
                f"{self.start.y:.2f}); expected free floor for a body of "
                f"{self.config.body.diameter} m; its station is at ({home.station.x:.2f}, "
                f"{home.station.y:.2f})"
            )
        self._random = np.random.default_rng(seed)
        self.dirt = DirtField(home.frame, home.solid)
        self.brought_in = 0
        self.in_bin = 0
        self.brushes_on = True
        brush = self.config.brush
        self._brush = np.array([brush.width, brush.depth, brush.efficiency], np.float64)
        self._bin_capacity = round(brush.bin_capacity * MICROGRAMS_PER_GRAM)
        self._next_falls = [self._first_fall(source) for source in home.dirt_sources]

    def step(self, wanted: Twist, dt: float) -> Observation:
        """Let ``dt`` s pass while the drive is asked for ``wanted``; return what is so then.

        Raises ValueError for a twist or a time that is not finite, or a time that is not above 0.
        """
        if not wanted.is_finite or not math.isfinite(dt) or dt <= 0.0:
            raise ValueError(f"expected a finite twist and dt > 0 s, got {wanted}, dt={dt}")
        before = self.body.pose
        twist_before = self.body.twist
        self.body.drive(wanted, dt)
        self.time += dt
        self._sweep(before, twist_before, dt)
        self._let_dirt_fall()
        return self.observe()

    def observe(self) -> Observation:
        """Return what is so now; no time passes."""
        pose = self.body.pose
        under = dirt_kernels.amount_under_disc(
            self.dirt.micrograms, self.dirt.place, pose.x, pose.y, self.config.body.radius
        )
        return Observation(
            time=self.time,
            pose=pose,
            odometry=self.start.inverse().compose(pose),
            twist=self.body.twist,
            bumper=self.body.bumper,
            dirt_under=under / MICROGRAMS_PER_GRAM,
            in_bin=self.in_bin / MICROGRAMS_PER_GRAM,
        )

    def spill(self, x: float, y: float, radius: float, grams: float) -> None:
        """Spill crumbs around a point of the map frame; raises ValueError as DirtField.spread."""
        self.brought_in += self.dirt.spread(x, y, radius, grams)

    def place_obstacle(self, x: float, y: float, radius: float) -> None:
        """Stand a round thing on the floor that no map knows; ValueError on the robot itself."""
        pose = self.body.pose
        if pose.distance_to(x, y) < radius + self.config.body.radius + self.home.frame.resolution:
            raise ValueError(f"the robot itself stands at ({x:.2f}, {y:.2f}); choose another place")
        self.body.replace_solid(self.body.solid | _disc(self.home, x, y, radius))

    def digest(self) -> str:
        """Return a SHA-256 over everything that can change, hexadecimal."""
        parts = [
            np.array([self.time], np.float64).tobytes(),
            self.body.state.tobytes(),
            self.dirt.micrograms.tobytes(),
            np.array([self.brought_in, self.in_bin], np.int64).tobytes(),
            np.array(self._next_falls, np.float64).tobytes(),
            str(self._random.bit_generator.state).encode(),
        ]
        return hashlib.sha256(b"".join(parts)).hexdigest()

    def _sweep(self, before: Pose, twist_before: Twist, dt: float) -> None:
        if not self.brushes_on:
            return
        after, twist = self.body.pose, self.body.twist
        travelled = math.hypot(after.x - before.x, after.y - before.y)
        turned = 0.5 * (twist_before.angular + twist.angular)
        self.in_bin += dirt_kernels.sweep(
            self.dirt.micrograms,
            self.dirt.place,
            self._brush,
            0.5 * (before.x + after.x),
            0.5 * (before.y + after.y),
            before.theta + 0.5 * turned * dt,
            math.copysign(travelled / dt, twist_before.linear + twist.linear),
            turned,
            dt,
            self._bin_capacity - self.in_bin,
        )

    def _first_fall(self, source: DirtSource) -> float:
        if source.amount > 0.0:
            self.spill(source.x, source.y, source.radius, source.amount)
        return self._wait_for_crumb(source)

    def _wait_for_crumb(self, source: DirtSource) -> float:
        if source.rate <= 0.0:
            return math.inf
        return float(self._random.exponential(_CRUMB / source.rate * _SECONDS_PER_HOUR))

    def _let_dirt_fall(self) -> None:
        for index, source in enumerate(self.home.dirt_sources):
            while self._next_falls[index] <= self.time:
                self._drop_crumb(source)
                self._next_falls[index] += self._wait_for_crumb(source)

    def _drop_crumb(self, source: DirtSource) -> None:
        """Let a crumb fall as the Gaussian of its source says, on floor; else it lands nowhere."""
        x_min, x_max, y_min, y_max = self.dirt.frame.extent
        reach = 3.0 * source.radius
        low = (max(x_min, source.x - reach), max(y_min, source.y - reach))
        high = (min(x_max, source.x + reach), min(y_max, source.y + reach))
        for _ in range(_TRIES):
            x, y = self._random.uniform(low, high).tolist()
            away = math.hypot(x - source.x, y - source.y) / source.radius
            if self._random.random() < math.exp(-0.5 * away**2) and self.dirt.is_floor(x, y):
                self.spill(x, y, self.dirt.frame.resolution, _CRUMB)
                return


def _disc(home: Home, x: float, y: float, radius: float) -> NDArray[np.bool_]:
    frame = home.frame
    rows, columns = np.indices(frame.shape)
    dy = frame.origin_y + (rows + 0.5) * frame.resolution - y
    dx = frame.origin_x + (columns + 0.5) * frame.resolution - x
    inside: NDArray[np.bool_] = dx**2 + dy**2 <= radius**2
    return inside
