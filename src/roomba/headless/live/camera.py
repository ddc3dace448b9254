"""The camera of a live headless robot."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import RequestRefusedError
from roomba.configuration.sensors import CameraConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.headless.embodied import Embodied
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

if TYPE_CHECKING:
    from roomba.world.camera.camera import Camera


@dataclass(frozen=True, slots=True, eq=False)
class _Sight:
    """The inputs of a picture: copies, since the robot's time passes while it is taken."""

    pose: Pose
    things: NDArray[np.float64]
    discs: NDArray[np.float64]
    dirt: NDArray[np.int32]
    frame: GridFrame


class LiveCamera:
    """Takes pictures in the thread of the caller, so that they do not hold up the robot's time."""

    def __init__(self, home: Home, config: CameraConfig, simulator: Simulator) -> None:
        """Make nothing yet: a camera needs some megabytes."""
        self._home, self._config, self._simulator = home, config, simulator
        self._lock = threading.Lock()
        self._camera: Camera | None = None

    def picture(
        self, ask: Callable[[Callable[[Embodied], _Sight]], _Sight], degrees: float
    ) -> NDArray[np.uint8]:
        """Return what is seen at an angle to the left, uint8 [height, width, 3] RGB.

        ``ask`` calls a function in the robot's thread. Raises RequestRefusedError for an angle that
        the camera does not turn to.
        """
        most = self._config.max_pan
        if not abs(degrees) <= most:
            raise RequestRefusedError(
                f"expected an angle from {-most:g} to {most:g} degrees, got {degrees:g}"
            )
        # Imported here: most runs take no picture, and loading the camera's loops takes a while.
        from roomba.world.camera.camera import Camera, Scene

        sight = ask(lambda _: self._sight())
        with self._lock:
            self._camera = self._camera or Camera(Scene.of(self._home), self._config, 1)
            self._camera.place_all(sight.things, sight.discs)
            picture = self._camera.picture(
                sight.pose, math.radians(degrees), sight.dirt, sight.frame
            )
            return picture.copy()

    def _sight(self) -> _Sight:
        simulator = self._simulator
        dirt = simulator.dirt
        return _Sight(
            simulator.pose,
            simulator.things.copy(),
            simulator.discs.copy(),
            dirt.micrograms.copy(),
            dirt.frame,
        )
