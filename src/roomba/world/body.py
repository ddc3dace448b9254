"""The round differential-drive body as it really moves, bumps and stands in its home."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.config import BodyConfig
from roomba.distance import distance_to_nearest
from roomba.geometry import Pose, Twist
from roomba.grid import GridFrame
from roomba.world import body_kernels as kernels


@dataclass(frozen=True, slots=True)
class Bumper:
    """Which halves of the front bumper are pressed; both at contact straight ahead."""

    left: bool = False
    right: bool = False

    @property
    def pressed(self) -> bool:
        """Whether any part is pressed."""
        return self.left or self.right


class Body:
    """The body in a home: :meth:`drive` moves it, never into what is solid."""

    def __init__(
        self,
        solid: NDArray[np.bool_],
        frame: GridFrame,
        config: BodyConfig,
        *,
        max_speed: float,
        start: Pose,
    ) -> None:
        """Stand still at ``start``; ``solid`` is bool [rows, columns] over ``frame``."""
        self._config = config
        self._frame = frame
        self._place = np.array([frame.resolution, frame.origin_x, frame.origin_y], np.float64)
        self.solid = solid
        self._room = room_around(solid, frame.resolution)
        self.max_speed = max_speed
        self.state: NDArray[np.float64] = np.zeros(kernels.STATE_SIZE, np.float64)
        self.state[: kernels.LINEAR] = start.x, start.y, start.theta

    @property
    def pose(self) -> Pose:
        """Where the body stands, in the map frame."""
        x, y, theta = self.state[: kernels.LINEAR].tolist()
        return Pose(x, y, theta)

    @property
    def twist(self) -> Twist:
        """How it moves."""
        return Twist(float(self.state[kernels.LINEAR]), float(self.state[kernels.ANGULAR]))

    @property
    def bumper(self) -> Bumper:
        """What its bumper feels."""
        return Bumper(bool(self.state[kernels.LEFT]), bool(self.state[kernels.RIGHT]))

    @property
    def gap(self) -> float:
        """Distance from its rim to the nearest solid thing, m, as far as one body radius."""
        radius = self._config.radius
        reach = 2.0 * radius
        x, y = self.state[kernels.X], self.state[kernels.Y]
        return float(kernels.distance_to_solid(self.solid, self._place, x, y, reach)) - radius

    def replace_solid(self, solid: NDArray[np.bool_]) -> None:
        """Change what is solid, when something was moved; the body stays where it is."""
        self.solid = solid
        self._room = room_around(solid, self._frame.resolution)

    def drive(self, wanted: Twist, dt: float) -> None:
        """Move for ``dt`` s towards the wanted twist, within limits, until something stops it."""
        kernels.drive(
            self.solid,
            self._room,
            self._place,
            self._limits(),
            self.state,
            wanted.linear,
            wanted.angular,
            dt,
        )

    def _limits(self) -> NDArray[np.float64]:
        config = self._config
        return np.array(
            [
                config.radius,
                self.max_speed,
                config.max_angular_speed,
                config.max_acceleration,
                config.max_deceleration,
                config.max_angular_acceleration,
            ],
            np.float64,
        )


def room_around(solid: NDArray[np.bool_], resolution: float) -> NDArray[np.float32]:
    """Return for each cell a distance, m, within which no point of it has anything solid near.

    From centre distances less a cell's diagonal; outside is solid. float32 [rows, columns].
    """
    cells = distance_to_nearest(np.pad(solid, 1, constant_values=True))[1:-1, 1:-1]
    room = (cells - np.float32(1.4143)) * np.float32(resolution)
    return np.ascontiguousarray(np.maximum(room, 0.0).astype(np.float32))
