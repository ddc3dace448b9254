"""The metric of Kümmerle et al. 2009: a trajectory judged by true relative poses.

R. Kümmerle, B. Steder, C. Dornhege, M. Ruhnke, G. Grisetti, C. Stachniss, A. Kleiner: On measuring
the accuracy of SLAM algorithms. Autonomous Robots 27 (2009). Relations are pairs of times and the
pose of the robot at the second one as seen from the first; the error of a pair is what is left
between that and the same of the estimated trajectory, so that where a map as a whole lies does not
count, and an error of long ago counts once.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.recordings.packed import Unpacked

_COLUMNS: Final = 8
"""The columns t1, t2 (s), x, y, z (m), roll, pitch, yaw (rad)."""
_PLANAR: Final = [2, 3, 7]
_FARTHEST: Final = 1.0
"""s; a relation counts if the trajectory has a pose so near to each of its times."""
_ROUNDED: Final = 1e-3
"""s; to which times in files are rounded."""
_PACKED: Final = ("", ".xz", ".gz", ".bz2")


@dataclass(frozen=True, slots=True)
class Errors:
    """What relations say of a trajectory: ``count`` were compared, ``skipped`` have no poses.

    Mean, standard deviation and largest of the errors of translation, m, and rotation, rad.
    """

    count: int
    skipped: int
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float]


def relations_beside(log: Path) -> Path | None:
    """Return the file of relations of a log, packed or not; None if there is none beside it."""
    suffixes = log.suffixes
    for count in range(len(suffixes) + 1):
        stem = log.name.removesuffix("".join(suffixes[len(suffixes) - count :]))
        for packed in _PACKED:
            path = log.parent / f"{stem}.relations{packed}"
            if path.is_file():
                return path
    return None


def load_relations(path: Path) -> Floats:
    """Return relations, float64 [n, 5]: t1, t2 (s), x, y (m), yaw (rad).

    Raises ValueError for a file of something else, and LogError for one that cannot be unpacked.
    """
    file = Unpacked(path)
    try:
        rows = np.loadtxt(file.path, ndmin=2)
    finally:
        file.close()
    if rows.shape[1:] != (_COLUMNS,) or not np.isfinite(rows).all():
        raise ValueError(f"{path}: expected lines of {_COLUMNS} finite numbers: relations")
    return np.asarray(rows[:, [0, 1, *_PLANAR]])


def errors(trajectory: Floats, relations: Floats) -> Errors:
    """Compare a trajectory, rows of t (s), x, y (m), theta (rad) in the order of time.

    Raises ValueError if it has no poses at the times of any relation.
    """
    first, second = relations[:, 0], relations[:, 1]
    is_known = _is_known(trajectory, first) & _is_known(trajectory, second)
    if not is_known.any():
        raise ValueError("expected a trajectory at the times of the relations, got another one")
    estimated = _between(
        poses_at(trajectory, first[is_known]), poses_at(trajectory, second[is_known])
    )
    off = _between(relations[is_known, 2:], estimated)
    translation, rotation = np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])
    count = int(np.count_nonzero(is_known))
    return Errors(count, len(relations) - count, _summary(translation), _summary(rotation))


def _summary(values: Floats) -> tuple[float, float, float]:
    return float(values.mean()), float(values.std()), float(values.max())


def _is_known(trajectory: Floats, times: Floats) -> NDArray[np.bool_]:
    stamps = trajectory[:, 0]
    after = np.clip(np.searchsorted(stamps, times), 1, len(stamps) - 1)
    away = np.minimum(np.abs(stamps[after] - times), np.abs(stamps[after - 1] - times))
    within = (times >= stamps[0] - _ROUNDED) & (times <= stamps[-1] + _ROUNDED)
    return np.asarray(within & (away <= _FARTHEST))


def poses_at(trajectory: Floats, times: Floats) -> Floats:
    """Return poses at times, float64 [n, 3], between those that are known."""
    stamps, x, y, theta = trajectory.T
    headings = np.interp(times, stamps, np.unwrap(theta))
    return np.column_stack((np.interp(times, stamps, x), np.interp(times, stamps, y), headings))


def _between(from_: Floats, to: Floats) -> Floats:
    """Return poses [n, 3] as seen from others."""
    cosine, sine = np.cos(from_[:, 2]), np.sin(from_[:, 2])
    x, y = (to[:, :2] - from_[:, :2]).T
    turn = np.remainder(to[:, 2] - from_[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    return np.column_stack((cosine * x + sine * y, cosine * y - sine * x, turn))
