"""A recorded drive followed on a map: on one that was made of it, or on one of another day.

Poses are compared with the trajectory that the map was made with, and covariances with these
errors: what share of the errors lies in the confidence region.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from roomba.arrays import Floats
from roomba.commands.localize.replay import Replay, Row
from roomba.commands.map.drive.mapped import MappedDrive
from roomba.commands.map.drive.whole_odometry import whole_odometry_of
from roomba.configuration.robot import load_robot_config
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan
from roomba_bench.slam.relations import poses_at

FAR: Final = 0.5
"""m; a pose with a larger error counts as of another place."""
HELD: Final = 0.95
"""The nominal share of errors in a covariance's confidence region."""
_COARSE: Final = 2
"""How many times larger the cells of the coarse map are."""
_NEAR_WALL: Final = 0.2
"""m; a beam that ends so near to a wall counts as one that hit it."""
_LAST: Final = 50
"""The last scans of a drive, by which its place is judged if no truth is known."""


@dataclass(frozen=True, slots=True, eq=False)
class Followed:
    """A drive that was localized on a map; errors count from when its place was first known.

    ``cells`` are the map's cells in words, and ``is_told`` whether a start was given. ``off`` are
    the errors of the place, m, [n]; ``squares`` the squared errors by the covariances, [n], where
    the place was known; ``found_after`` is the way until then, m, None if it was never known.
    """

    cells: str
    is_told: bool
    off: Floats
    squares: Floats
    found_after: float | None

    @property
    def case(self) -> str:
        """What was done, in words."""
        start = "from a given start" if self.is_told else "from no start"
        return f"on its own map, {self.cells}, {start}"

    @property
    def median(self) -> float:
        """The median of the errors, m."""
        return float(np.median(self.off))

    @property
    def far(self) -> float:
        """The share of poses of another place, 0..1."""
        return float(np.mean(self.off > FAR))

    @property
    def held(self) -> float:
        """The share of errors in the 95 % confidence region, 0..1."""
        return float(np.mean(self.squares < square_of(HELD)))


@dataclass(frozen=True, slots=True)
class Fitting:
    """A drive on a map of another day: the way until its place was known, m, and beams at walls."""

    case: str
    found_after: float | None
    at_walls: float


def square_of(share: float) -> float:
    """Return the chi-squared quantile of a share, with two degrees of freedom."""
    return float(-2.0 * np.log1p(-share))


def followed_on_own_map(log: Path, drive: MappedDrive) -> Iterator[Followed]:
    """Yield a drive localized on its own map and on a coarse one, with a start and without."""
    trajectory = drive.trajectory
    begin = Pose(*trajectory[0, 1:].tolist())
    for occupancy in (drive.occupancy, coarsened(drive.occupancy, _COARSE)):
        cells = f"{100.0 * occupancy.frame.resolution:.0f} cm cells"
        for start in (begin, None):
            rows = _rows(log, occupancy, start)
            yield _judged(cells, start is not None, rows, trajectory)


def fitting_on(log: Path, map_file: Path) -> Fitting:
    """Return how well a drive fits a map of another day, on which no start is given.

    Raises RoombaError for a map that cannot be read.
    """
    occupancy = load_map(map_file)
    rows = _rows(log, occupancy, None)
    known = [row for row in rows if row.estimate.knowledge.is_usable]
    if not known:
        return Fitting(f"on {map_file.stem}, from no start", None, 0.0)
    share = _at_walls(log, occupancy, known)
    return Fitting(f"on {map_file.stem}, from no start", known[0].way, share)


def map_beside(log: Path, name: str) -> Path | None:
    """Return the other day's map beside a log: ``wean_map.yaml`` belongs to ``wean_...``."""
    for path in sorted(log.parent.glob("*_map.yaml")):
        if name.startswith(path.stem.removesuffix("map")):
            return path
    return None


def coarsened(occupancy: OccupancyMap, times: int) -> OccupancyMap:
    """Return a map with cells ``times`` as large: occupied if one of the small cells is."""
    frame = occupancy.frame
    rows, columns = -(-frame.rows // times), -(-frame.columns // times)
    values = np.full((rows * times, columns * times), UNKNOWN, np.int8)
    values[: frame.rows, : frame.columns] = occupancy.values
    blocks = values.reshape(rows, times, columns, times)
    coarse = np.full((rows, columns), UNKNOWN, np.int8)
    coarse[(blocks == FREE).any(axis=(1, 3))] = FREE
    coarse[(blocks == OCCUPIED).any(axis=(1, 3))] = OCCUPIED
    wide = frame.resolution * times
    return OccupancyMap(GridFrame(wide, frame.origin_x, frame.origin_y, rows, columns), coarse)


def _rows(log: Path, occupancy: OccupancyMap, start: Pose | None) -> list[Row]:
    """Return what was known at each moment of a drive."""
    config = load_robot_config(CONFIGURATION / "robot.yaml")
    with LoggedDrive([log]) as drive:
        replay = Replay(occupancy, config, whole_odometry_of(drive, config), start)
        heard = (replay.hear(reading) for reading in drive.readings())
        return [row for row in heard if row is not None]


def _judged(cells: str, is_told: bool, rows: list[Row], trajectory: Floats) -> Followed:
    """Compare rows with the trajectory that the map was made with."""
    usable = [number for number, row in enumerate(rows) if row.estimate.knowledge.is_usable]
    if not usable:
        return Followed(cells, is_told, np.array([np.inf]), np.array([np.inf]), None)
    first, last = trajectory[0, 0], trajectory[-1, 0]
    kept = [row for row in rows[usable[0] :] if first <= row.scan_stamp <= last]
    true = poses_at(trajectory, np.array([row.scan_stamp for row in kept]))
    poses = np.array([(row.estimate.pose.x, row.estimate.pose.y) for row in kept])
    off = poses - true[:, :2]
    spread = np.array([row.estimate.covariance[:2, :2] for row in kept])
    squares = np.einsum("ni,nij,nj->n", off, np.linalg.inv(spread), off)
    known = np.array([row.estimate.knowledge.is_usable for row in kept])
    away = np.hypot(off[:, 0], off[:, 1])
    return Followed(cells, is_told, away, squares[known], rows[usable[0]].way)


def _at_walls(log: Path, occupancy: OccupancyMap, known: list[Row]) -> float:
    """Return the share of the last scans' beams that end at walls, by the localized poses."""
    frame, stamps = occupancy.frame, np.array([row.scan_stamp for row in known])
    is_open = (occupancy.values != OCCUPIED).astype(np.uint8)
    away = frame.resolution * cv2.distanceTransform(is_open, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    with LoggedDrive([log]) as drive:
        scans = [each for each in drive.readings() if isinstance(each.value, LidarScan)][-_LAST:]
    shares = []
    for stamp, scan, _ in scans:
        assert isinstance(scan, LidarScan)
        row = known[min(int(np.searchsorted(stamps, stamp)), len(known) - 1)]
        ends = scan.lidar.view(scan.ranges).ends_at(row.estimate.pose)
        inside = [frame.cell_of(x, y) for x, y in ends.tolist() if frame.contains(x, y)]
        near = sum(float(away[cell]) < _NEAR_WALL for cell in inside)
        shares.append(near / max(len(ends), 1))
    return float(np.mean(shares))
