"""The table's rows about mapped drives."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Final

from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.slam.localized import HELD, Fitting, Followed
from roomba_bench.slam.peers import Reached, aims_of, amcl_at_walls, amcl_of, peers_of
from roomba_bench.slam.relations import Errors
from roomba_bench.slam.run import Judged

TOPIC = "slam"
ODOMETRY: Final = "odometry alone"
SPEED_AIM: Final = 100.0
"""Times real time, on one core."""
PLACE_AIM: Final = 0.05
"""m; median error of the place on a map of the same drive."""
FOUND_AIM: Final = 40.0
"""m; way by odometry after which the place is known on a map of another day."""


def rows_of(judged: Judged) -> Iterator[Record]:
    """Yield the rows of a drive."""
    if judged.ours is not None and judged.by_odometry is not None:
        yield from _error_rows(judged.name, judged.ours, judged.by_odometry)
    replay = judged.drive.replay
    fitting = 100.0 * replay.unconfirmed / replay.scans
    yield _row(judged.name, "scans that fitted nothing seen before", fitting, "%")
    yield Record(
        TOPIC,
        judged.name,
        "times real time",
        judged.times_real_time,
        "x, one core",
        Better.HIGHER,
        SPEED_AIM,
    )
    for followed in judged.followed:
        yield from _followed_rows(judged.name, followed)
    if judged.fitting is not None:
        yield from _fitting_rows(judged.name, judged.fitting)


def broken_row(name: str, error: Exception) -> Record:
    """Return the row of a log that cannot be read."""
    reason = f"{type(error).__name__}: {error}"
    return Record(TOPIC, name, "everything", None, "", Better.LOWER, error=reason)


def _error_rows(name: str, ours: Errors, blind: Errors) -> Iterator[Record]:
    aims, peers = aims_of(name), peers_of(name)
    counted = f"of {ours.count} relations"
    values = zip(("mean", "deviation", "largest"), ours.translation, blind.translation, strict=True)
    published: tuple[Callable[[Reached], float | None], ...]
    published = (lambda peer: peer.translation, lambda peer: peer.deviation, lambda _: None)
    reach = zip((aims.translation, None, aims.largest), published, strict=True)
    for (word, value, by_odometry), (aim, of) in zip(values, reach, strict=True):
        beside = _beside(by_odometry, peers, of)
        yield _row(name, f"translation error, {word}, {counted}", value, "m", aim, beside)
    turns = zip(("mean", "deviation", "largest"), ours.rotation, blind.rotation, strict=True)
    for word, turn, by_odometry in turns:
        is_mean = word == "mean"
        beside = _beside(
            math.degrees(by_odometry), peers if is_mean else (), lambda peer: peer.rotation
        )
        aim = aims.rotation if is_mean else None
        figure = f"rotation error, {word}, {counted}"
        yield _row(name, figure, math.degrees(turn), "degrees", aim, beside)


def _followed_rows(name: str, followed: Followed) -> Iterator[Record]:
    case = f"{name}, {followed.case}"
    if followed.found_after is None:
        yield Record(TOPIC, case, "error of the place, median", None, "m", Better.LOWER, PLACE_AIM,
                     error="its place was never known")  # fmt: skip
        return
    amcl = amcl_of(name)
    medians = tuple(PeerFigure(each.name, value=each.median) for each in amcl)
    shares = tuple(PeerFigure(each.name, value=100.0 * each.far) for each in amcl)
    yield _row(case, "error of the place, median", followed.median, "m", PLACE_AIM, medians)
    yield _row(case, "poses more than 0.5 m off", 100.0 * followed.far, "%", 0.0, shares)
    held = 100.0 * followed.held
    figure = "errors in the region that should hold 95 %"
    yield Record(TOPIC, case, figure, held, "%", Better.HIGHER, 100.0 * HELD)
    yield _row(case, "way until its place was known", followed.found_after, "m")


def _fitting_rows(name: str, fitting: Fitting) -> Iterator[Record]:
    case, figure = f"{name}, {fitting.case}", "way until its place was known"
    if fitting.found_after is None:
        yield Record(TOPIC, case, figure, None, "m", Better.LOWER, FOUND_AIM,
                     error="its place was never known")  # fmt: skip
        return
    yield _row(case, figure, fitting.found_after, "m", FOUND_AIM)
    peers = tuple(PeerFigure(each, value=value) for each, value in amcl_at_walls(name))
    at_walls = 100.0 * fitting.at_walls
    figure = "beams of the last scans within 0.2 m of walls"
    yield Record(TOPIC, case, figure, at_walls, "%", Better.HIGHER, None, peers)


def _beside(
    by_odometry: float, peers: tuple[Reached, ...], of: Callable[[Reached], float | None]
) -> tuple[PeerFigure, ...]:
    """Return the figure of odometry, and those of other programs that published it."""
    others = (PeerFigure(peer.name, value=of(peer)) for peer in peers if of(peer) is not None)
    return (PeerFigure(ODOMETRY, value=by_odometry), *others)


def _row(
    name: str,
    figure: str,
    value: float,
    unit: str,
    aim: float | None = None,
    peers: tuple[PeerFigure, ...] = (),
) -> Record:
    return Record(TOPIC, name, figure, value, unit, Better.LOWER, aim, peers)
