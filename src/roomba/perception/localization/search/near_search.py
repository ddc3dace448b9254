"""A search around a pose for where a scan fits, as wheels slipped, or a turn was not measured."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.search.matched import evenly_chosen, matched
from roomba.perception.localization.search.search_kernels import score_heading
from roomba.perception.matching.scan_view import Fit, ScanView
from roomba.perception.matching.surface_field import SurfaceField

_STEP: Final = 0.12
_TURN_STEP: Final = 0.07
"""m, rad; steps between poses that are tried: a match finds its way from half a step."""
_WIDTH: Final = 0.35
"""m; a beam that ends farther than this from a surface adds nothing."""
_BEAMS: Final = 48
_MATCHED: Final = 8
"""Beams by which poses are compared, and the number of the best poses that are then matched."""
_LEAST_ROOM: Final = 0.05
"""m; a robot's middle is never nearer than this to a surface."""


def best_near(
    view: ScanView, field: SurfaceField, pose: Pose, config: LocalizationConfig
) -> tuple[Pose, Fit] | None:
    """Return the pose around ``pose``, map frame, that a scan fits best, and how well it fits.

    None where nothing around has room for a robot.
    """
    spots, turn = _spots(field, pose, config.searching.near_way), config.searching.near_turn
    if not len(spots) or not len(view):
        return None
    chosen = evenly_chosen(len(view), _BEAMS)
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

    ``usual`` are the usual shares of beams that agree, and that go through walls. Return None if
    there is no such pose.
    """
    found, worse = best_near(view, field, pose, config), config.fit
    if found is None:
        return None
    _, fit = found
    is_usual = (
        fit.agree >= usual[0] - worse.near_worse and fit.through <= usual[1] + worse.near_through
    )
    lead = fit.evidence - view.fit(field, pose.as_array()).evidence
    return found if is_usual and lead >= config.needed_evidence else None


def _spots(field: SurfaceField, pose: Pose, way: float) -> NDArray[np.float64]:
    """Return a lattice of places up to ``way``, m, beside a pose that have room, [n, 2], m."""
    side = np.arange(-way, way + 1e-9, _STEP)
    x, y = (each.ravel() for each in np.meshgrid(pose.x + side, pose.y + side))
    frame = field.frame
    rows, columns = frame.cells_of(x, y)
    inside = frame.holds(rows, columns)
    x, y, rows, columns = x[inside], y[inside], rows[inside], columns[inside]
    has_room = field.values[rows, columns] >= _LEAST_ROOM
    return np.column_stack((x[has_room], y[has_room]))
