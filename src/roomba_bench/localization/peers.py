"""Other people's scan matchers, on the scans of one of our drives."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OccupancyMap
from roomba.perception.localization.belief.belief import numbers_of, unknown_belief
from roomba.perception.localization.belief.reckon_kernels import carry
from roomba.perception.localization.tracker import Tracker
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba_bench.bench import Bench
from roomba_bench.contestants import ContestantError, Local, Peer
from roomba_bench.localization.drive import Errors, errors
from roomba_bench.localization.robot import home_named
from roomba_bench.localization.rows import (
    MATCH_AIM,
    ODOMETRY,
    RECKONED,
    TOPIC,
    error_rows,
    figures,
)
from roomba_bench.ours_sim import ROBOT
from roomba_bench.peers.protocol import Work
from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.rounds import milliseconds

MATCHERS = (
    ("small_gicp", "matching.small_gicp", "small_gicp"),
    ("kiss-icp (no map)", "matching.kiss_icp", "kiss-icp"),
)
"""Name in the table, script, and distribution."""
_SPACING = 0.02
"""m; between points on the map's surfaces."""
_MATCHES = 600
"""Scans that are matched again and again: those of a minute."""
_SPREAD = (0.002**2, 0.002**2, 0.002**2)
"""m2 ahead and left, rad2; about the variance that a tenth of a second adds to a pose."""


@dataclass(frozen=True)
class ScannedDrive:
    """The file with a drive's scans, and the home, as in a drive's task."""

    home: str
    folder: str
    scans: Path


@dataclass(frozen=True)
class Followed:
    """Errors of each source at each scan of a drive; ``left_out``: peers not measured, and why."""

    stamps: Floats
    errors: dict[str, Errors]
    left_out: tuple[PeerFigure, ...]

    def rows(self, case: str) -> list[Record]:
        """Return the rows of the drive."""
        of = {name: figures(off) for name, off in self.errors.items()}
        ours = of.pop("ours")
        return error_rows(case, ours, dict(of), self.left_out, has_aims=False)


def follow(bench: Bench, drives: Sequence[ScannedDrive], at_once: int) -> list[Followed]:
    """Let the peers follow drives, so many at a time: their time is not measured here."""
    peers = [peer for drive in drives for peer in _peers(bench, drive)]
    with ThreadPoolExecutor(at_once) as pool:
        answers = list(pool.map(_follow, peers))
    return [
        _followed(drive, answers[len(MATCHERS) * at : len(MATCHERS) * (at + 1)])
        for at, drive in enumerate(drives)
    ]


def match_row(bench: Bench, drive: ScannedDrive) -> Record:
    """Return how long one match takes, from ranges to a pose."""
    with np.load(drive.scans) as arrays:
        first = {name: arrays[name][:_MATCHES] for name in arrays.files}
    short = ScannedDrive(drive.home, drive.folder, bench.folder / "matches.npz")
    np.savez(short.scans, **first)
    contestants = [matcher for matcher, _ in _peers(bench, short)]
    ours, *peers = bench.compete([Local("ours", lambda: _matching(short)), *contestants])
    return Record(
        TOPIC,
        f"{drive.home}, scan of 360 beams to the map, one core",
        "one match",
        None if ours.rate is None else milliseconds(ours.rate),
        "ms",
        Better.LOWER,
        MATCH_AIM,
        tuple(peer.figure(milliseconds) for peer in peers),
        ours.error,
    )


def surfaces(occupancy: OccupancyMap) -> Floats:
    """Return points along all borders of free floor in a map, float64 [points, 2], m."""
    free, solid = occupancy.values == FREE, occupancy.solid
    frame = occupancy.frame
    per_side = max(1, round(frame.resolution / _SPACING))
    along = (np.arange(per_side) + 0.5) / per_side
    sides = []
    for turned, (here, there) in enumerate(((free, solid), (free.T, solid.T))):
        borders = (here[:, :-1] & there[:, 1:]) | (there[:, :-1] & here[:, 1:])
        rows, columns = np.nonzero(borders)
        cells = np.column_stack(
            [np.repeat(columns + 1.0, per_side), (rows[:, None] + along).ravel()]
        )
        sides.append(cells[:, ::-1] if turned else cells)
    return np.vstack(sides) * frame.resolution + (frame.origin_x, frame.origin_y)


def _peers(bench: Bench, drive: ScannedDrive) -> list[tuple[Peer, Path]]:
    """Return the peers for a drive, and the file that each writes its poses to."""
    home = home_named(drive.home, drive.folder)
    lidar = ROBOT.lidar
    case = {
        "scans": str(drive.scans),
        "surfaces": bench.save("surfaces", surfaces(home.map)),
        "start": [home.station.x, home.station.y, home.station.theta],
        "nearest": lidar.min_range,
        "farthest": lidar.max_range,
    }
    files = [drive.scans.with_suffix(f".{module}.npy") for _, module, _ in MATCHERS]
    return [
        (bench.peer(name, module, {**case, "poses": str(file)}, distribution), file)
        for (name, module, distribution), file in zip(MATCHERS, files, strict=True)
    ]


def _follow(peer_and_file: tuple[Peer, Path]) -> tuple[Floats, str] | str:
    """Return a peer's poses and version, or the reason why there are none."""
    peer, file = peer_and_file
    try:
        version, _ = peer.prepare()
        return np.load(file), version
    except ContestantError as error:
        return str(error)
    finally:
        peer.end()


def _followed(drive: ScannedDrive, answers: Sequence[tuple[Floats, str] | str]) -> Followed:
    with np.load(drive.scans) as arrays:
        stamps, true = arrays["stamps"], arrays["truth"]
        off = {"ours": errors(true, arrays["believed"])}
        own = {
            RECKONED: errors(true, arrays["reckoned"]),
            ODOMETRY: errors(true, arrays["odometry"]),
        }
    left_out = []
    for (name, _, _), answer in zip(MATCHERS, answers, strict=True):
        if isinstance(answer, str):
            left_out.append(PeerFigure(name, error=answer))
        else:
            off[f"{name} {answer[1]}".rstrip()] = errors(true, answer[0])
    return Followed(stamps, off | own, tuple(left_out))


def _matching(drive: ScannedDrive) -> Work:
    """Return the work of following a drive with our tracker, scan by scan, again and again."""
    home, config = home_named(drive.home, drive.folder), ROBOT
    lidar = config.lidar
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    field = SurfaceField.of(home.map)
    with np.load(drive.scans) as arrays:
        ranges, reckoned = arrays["ranges"], arrays["reckoned"].tolist()
    first, *later = [Pose(*row) for row in reckoned]
    steps = [
        one.inverse().compose(other)
        for one, other in zip([home.station, first, *later], [first, *later], strict=False)
    ]
    tracker = _tracker(field, config, home.station)
    at = 0

    def work() -> float:
        nonlocal tracker, at
        if at == len(ranges):
            tracker, at = _tracker(field, config, home.station), 0
        _move(tracker, steps[at])
        tracker.see(model.view(ranges[at]))
        at += 1
        return 1.0

    return Work(work)


def _tracker(field: SurfaceField, config: RobotConfig, pose: Pose) -> Tracker:
    numbers = numbers_of(config.localization, config.gyro)
    unsure = np.diag([0.05**2, 0.05**2, 0.05**2])
    return Tracker(field, pose, unsure, unknown_belief(), numbers)


def _move(tracker: Tracker, step: Pose) -> None:
    """Move a tracker by a step in the robot's frame."""
    pose, covariance = tracker.pose.as_array(), tracker.covariance
    carry(pose, covariance, step.x, step.y, step.theta, *_SPREAD)
    tracker.pose, tracker.covariance = Pose(*pose.tolist()), covariance
