"""Where a mapped robot was at each scan: as it was known then, and as it is known at the end."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from roomba.arrays import Floats
from roomba.files.atomic import write_output
from roomba.geometry import Pose

if TYPE_CHECKING:
    from roomba.perception.slam.mapper import Mapper


class Trajectory:
    """Keeps each scan's pose relative to the newest keyframe, which may be moved afterwards."""

    def __init__(self) -> None:
        """Begin without a scan."""
        self._online: list[tuple[float, float, float, float]] = []
        self._beside: list[tuple[int, Pose]] = []

    def add(self, stamp: float, mapper: Mapper) -> None:
        """Note a scan that a mapper, whose map has begun, took just now; ``stamp`` in s."""
        if not mapper.version:
            return
        here = mapper.at_scan
        number, keyframe = mapper.newest_keyframe
        self._online.append((stamp, here.x, here.y, here.theta))
        self._beside.append((number, keyframe.inverse().compose(here)))

    @property
    def online(self) -> Floats:
        """Rows of t (s), x, y (m), theta (rad) of the body, map frame, as known at the time."""
        return np.array(self._online).reshape(-1, 4)

    def at_the_end(self, mapper: Mapper) -> Floats:
        """Return the same rows as the finished map has them."""
        keyframes = [Pose(*pose) for pose in mapper.trajectory.tolist()]
        rows = []
        for (stamp, *_), (number, beside) in zip(self._online, self._beside, strict=True):
            here = keyframes[number].compose(beside)
            rows.append((stamp, here.x, here.y, here.theta))
        return np.array(rows).reshape(-1, 4)


def write_trajectory(path: Path, rows: Floats) -> None:
    """Write rows of t (s), x, y (m), theta (rad) as lines of text; raises OSError."""
    lines = [trajectory_line(t, Pose(*pose)) for t, *pose in rows.tolist()]
    write_output(path, "".join(lines).encode())


def trajectory_line(stamp: float, pose: Pose) -> str:
    """Return the line ``t x y theta`` of a pose; s, m, rad."""
    return f"{stamp:.6f} {pose.x:.6f} {pose.y:.6f} {pose.theta:.7f}\n"
