"""Looking around a pose for where a scan fits: wheels slipped, or a turn was not told."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.search.search_kernels import score_heading
from roomba.perception.matching.match_kernels import match
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

_STEP: Final = 0.12
_TURN_STEP: Final = 0.07
"""m, rad; between poses that are tried: a match finds its way from half of that."""
_WIDTH: Final = 0.35
"""m; a beam that ends farther than this from a surface adds nothing."""
_BEAMS: Final = 48
_MATCHED: Final = 8
"""Beams that are compared, and poses that are matched."""
_SCALES: Final = np.array([0.40, 0.30, 0.20, 0.10, 0.05, 0.05])
"""m; beams that end farther off than this lose weight, round by round."""
_SPREAD: Final = np.diag([0.3**2, 0.3**2, 0.2**2])
"""m2, rad2; of a pose that is tried."""
_LEAST_ROOM: Final = 0.05
"""m; nearer than this to a surface no robot's middle is."""


def best_near(
    view: ScanView, field: SurfaceField, pose: Pose, config: LocalizationConfig
) -> tuple[Pose, Fit] | None:
    """Return the pose around ``pose``, map frame, that a scan fits best, and how well it fits.

    None where nothing around has room for a robot.
    """
    spots, turn = _spots(field, pose, config.searching.near_way), config.searching.near_turn
    if not len(spots) or not len(view):
        return None
    chosen = np.unique(np.linspace(0, len(view) - 1, _BEAMS).astype(np.int64))
    scores, headings = np.zeros(len(spots), np.float32), np.zeros(len(spots), np.float32)
    for off in np.arange(-turn, turn + 1e-9, _TURN_STEP):
        score_heading(
            field.values,
            field.place,
            view.ends,
            chosen,
            spots,
            pose.theta + float(off),
            _WIDTH,
            scores,
            headings,
        )
    best = np.argsort(-scores, kind="stable")[:_MATCHED]
    starts = np.column_stack((spots[best], headings[best].astype(np.float64)))
    deviation = config.beam_deviation
    tried = [matched(view, field, Pose(*start), deviation) for start in starts.tolist()]
    return max(tried, key=lambda each: each[1].evidence)


def better_near(
    view: ScanView,
    field: SurfaceField,
    pose: Pose,
    usual: tuple[float, float],
    config: LocalizationConfig,
) -> tuple[Pose, Fit] | None:
    """Return a pose near ``pose``, map frame, that a scan fits clearly better, and about as usual.

    ``usual`` are shares of beams that agree, and that go through walls. None: there is no such.
    """
    found, worse = best_near(view, field, pose, config), config.fit
    if found is None:
        return None
    _, fit = found
    is_usual = (
        fit.agree >= usual[0] - worse.near_worse and fit.through <= usual[1] + worse.near_through
    )
    lead = fit.evidence - view.fit(field, np.array([pose.x, pose.y, pose.theta])).evidence
    return found if is_usual and lead >= config.needed_evidence else None


def matched(view: ScanView, field: SurfaceField, start: Pose, deviation: float) -> tuple[Pose, Fit]:
    """Return where a scan fits best from a start on, and how well; ``deviation`` is a beam's, m."""
    prior = np.array([start.x, start.y, start.theta])
    pose, covariance = prior.copy(), _SPREAD.copy()
    match(
        field.values,
        field.place,
        view.ends,
        len(view),
        prior,
        covariance,
        _SCALES,
        deviation * deviation,
        pose,
    )
    return Pose(float(pose[0]), float(pose[1]), wrap_angle(float(pose[2]))), view.fit(field, pose)


def _spots(field: SurfaceField, pose: Pose, way: float) -> NDArray[np.float64]:
    """Return a lattice of places up to ``way``, m, beside a pose that have room, [n, 2], m."""
    side = np.arange(-way, way + 1e-9, _STEP)
    x, y = (each.ravel() for each in np.meshgrid(pose.x + side, pose.y + side))
    frame = field.frame
    columns = np.floor((x - frame.origin_x) / frame.resolution).astype(np.int64)
    rows = np.floor((y - frame.origin_y) / frame.resolution).astype(np.int64)
    inside = (rows >= 0) & (rows < frame.rows) & (columns >= 0) & (columns < frame.columns)
    x, y, rows, columns = x[inside], y[inside], rows[inside], columns[inside]
    has_room = field.values[rows, columns] >= _LEAST_ROOM
    return np.column_stack((x[has_room], y[has_room]))
