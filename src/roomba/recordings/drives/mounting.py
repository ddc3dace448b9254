"""Where the sensors of a recorded drive are on its robot: as is told, or as the drive shows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from roomba.perception.matching.mounts import UPRIGHT, UPSIDE_DOWN, Mount, Mounts
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.log import Log
from roomba.recordings.readings import Kind

BODIES: Final = ("base_link", "base_footprint", "base")
"""Frames of a robot's body that lie on each other as seen from above."""
_FARTHEST: Final = 10.0
"""m; a lidar is not farther from the middle of its robot, as `--laser` has it, too."""


class Mounting:
    """Tells where frames are on the frame ``body``; ``notes`` says what was doubtful."""

    def __init__(self, logs: Sequence[Log], body: str, wanted: Wanted) -> None:
        """Take the transforms of logs; a mount of the lidar that is ``wanted`` takes precedence."""
        self._body = body
        self._laser, self._is_upside_down = wanted.laser, wanted.laser_is_upside_down
        self._mounts = Mounts()
        for log in logs:
            self._mounts.add(log.transforms())
        self._found: dict[tuple[str, Kind], Mount] = {}
        self._remarks: list[str] = []
        self._untold: dict[str, str] = {}
        self._shown: Mount | None = None

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of the lidars that were asked for so far."""
        return [*self._remarks, *map(self._words_of_untold, self._untold.values())]

    @property
    def is_told(self) -> bool:
        """Whether it was told where each lidar is that was asked for."""
        return not self._untold

    def take(self, shown: Mount) -> None:
        """Use ``shown``, by the drive, from now on for a lidar of which nothing is told."""
        self._shown = shown

    def of(self, frame: str, kind: Kind) -> Mount:
        """Return where a sensor is: in the middle, and looking ahead, if nothing tells."""
        if kind is Kind.SCAN and self._laser is None and frame in self._untold:
            return self._shown or Mount()
        if (frame, kind) not in self._found:
            self._found[frame, kind] = self._searched(frame, kind)
        mount = self._found[frame, kind]
        if kind is not Kind.SCAN or self._laser is None:
            return mount
        hangs = self._is_upside_down
        if hangs is None:
            return Mount(self._laser, mount.up)
        return Mount(self._laser, UPSIDE_DOWN if hangs else UPRIGHT)

    def _searched(self, frame: str, kind: Kind) -> Mount:
        is_asked = kind is Kind.SCAN and self._laser is None
        for body in (self._body, *(BODIES if self._body in BODIES else ())):
            mount = self._mounts.mount(body, frame)
            if mount is None:
                continue
            away = math.hypot(mount.pose.x, mount.pose.y)
            if is_asked and away > _FARTHEST:
                return self._taken(
                    frame,
                    f"{frame!r} was recorded to be {away:.0f} m from {body!r}, as if that were in "
                    "mm",
                )
            if is_asked and body != self._body:
                self._remarks.append(f"{frame!r} is where it is on {body!r}, not on {self._body!r}")
            return mount
        if not is_asked:
            return Mount()
        return self._taken(frame, f"no transform from {self._body!r} to {frame!r} was recorded")

    def _taken(self, frame: str, why: str) -> Mount:
        """Return where a lidar is taken to be, and note why nothing tells."""
        self._untold[frame] = why
        return self._shown or Mount()

    def _words_of_untold(self, why: str) -> str:
        looks = "to look ahead"
        if self._shown is not None:
            yaw = self._shown.pose.theta
            looks = f"to look {degrees_aside(yaw)}" if yaw else looks
            looks += " and to hang upside down" if self._shown.is_upside_down else ""
            looks += ", as its scans show against the odometry"
        return (
            f"{why}: the lidar is taken to be in the middle of the robot, and {looks}; --laser "
            "X,Y,YAW[,upside-down] says where it is"
        )


def degrees_aside(yaw: float) -> str:
    """Return in words how far to the left, rad, something looks."""
    return f"{math.degrees(abs(yaw)):.0f} degrees to the {'left' if yaw > 0.0 else 'right'}"
