"""An LD19 made up: frames, byte for byte, of what a simulated robot's lidar sees.

It turns clockwise, ten times a second. The simulated lidar measures all of its beams at once, at
each step of the world. A frame has the beams towards which the lidar looks, of the step that is
nearest in time.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.drivers.lidars.ld19 import END, HEAD, LAP, POINT, POINTS, START, crc8
from roomba.emulators.living import STEP
from roomba.world.simulator import Simulator

TURNS: Final = 10
"""A second."""
_INTENSITY: Final = 200
"""Of an echo (assumed); it is not simulated."""


def with_ld19(config: SimulatedRobotConfig) -> SimulatedRobotConfig:
    """Return a robot whose simulated lidar measures what an LD19 on it sees, step by step."""
    turning = config.with_lidar("ld19")
    lidar = turning.lidar.model_copy(update={"rate": 1.0 / STEP, "sweep_time": 0.0})
    return turning.model_copy(update={"lidar": lidar})


def known_ld19(config: LidarConfig) -> LidarConfig:
    """Return what a driver knows of the lidar of :func:`with_ld19`: that it turns."""
    return config.model_copy(update={"rate": float(TURNS), "sweep_time": 1.0 / TURNS})


class Ld19Emulator:
    """Turns as the world goes on: :meth:`advance` returns what it sends of a step."""

    def __init__(self, simulator: Simulator) -> None:
        """See what the lidar of ``simulator`` sees, which is that of :func:`with_ld19`."""
        self._simulator = simulator
        self._beams = simulator.config.lidar.beams
        self._sent = 0
        self._before = simulator.ranges

    def advance(self) -> bytes:
        """Return the frames that are due by now."""
        rate = TURNS * self._beams
        due = round(self._simulator.time * rate)
        middle = (self._simulator.time - 0.5 * STEP) * rate
        before, self._before = self._before, self._simulator.ranges
        frames = b""
        while self._sent + POINTS <= due:
            places = np.arange(self._sent, self._sent + POINTS) % self._beams
            ranges = before if self._sent + POINTS // 2 < middle else self._before
            # Beams count counter-clockwise, and the points of a frame clockwise.
            seen = ranges[-places]
            self._sent += POINTS
            measured = (self._sent - 1) / self._beams / TURNS
            frames += frame(places * (360.0 / self._beams), seen, measured, 360.0 * TURNS)
        return frames


def frame(
    angles: NDArray[np.float64], ranges: NDArray[np.float32], time: float, speed: float
) -> bytes:
    """Return a frame: ``angles`` [POINTS], degrees, clockwise; ``ranges``, m, inf: no echo.

    ``time`` is that of its last point, s, ``speed`` in degrees/s. Raises ValueError for another
    number of points.
    """
    if len(angles) != POINTS or len(ranges) != POINTS:
        raise ValueError(f"expected {POINTS} points of a frame, got {len(ranges)}")
    points = b"".join(
        POINT.pack(round(1e3 * distance), _INTENSITY) if np.isfinite(distance) else POINT.pack(0, 0)
        for distance in ranges.tolist()
    )
    first, last = (round(100.0 * float(angle)) for angle in (angles[0], angles[-1]))
    whole = START.pack(HEAD, round(speed), first) + points
    whole += END.pack(last, int(1e3 * time) % LAP, 0)[:-1]
    return whole + bytes([crc8(whole)])
