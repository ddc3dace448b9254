"""Searching a map for the places where a scan could have been taken, a piece at a time."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.perception.localization.search.matched import evenly_chosen
from roomba.perception.localization.search.search_kernels import cells_with_room, score_heading
from roomba.perception.matching.surface_field import SurfaceField

STEP: Final = 0.15
"""m; between places that are tried: the match finds its way from half of that."""
TURN: Final = math.radians(4.0)
"""rad; between headings that are tried."""
WIDTH: Final = 0.35
"""m; a beam that ends farther than this from a surface adds nothing to a place's score."""
BEAMS: Final = 48
"""Number of beams that are compared: more take longer and find no more."""
PIECE: Final = 200_000
"""Poses that are tried at once: some 10 ms of work."""


class PlaceSearch:
    """One search; call :meth:`advance` until it returns True."""

    def __init__(
        self,
        field: SurfaceField,
        ends: NDArray[np.float64],
        body_radius: float,
    ) -> None:
        """Search for where ``ends`` (float64 [beams, 4], see ``beam_ends``) were measured from.

        Only places where a body of ``body_radius`` m finds room are tried.
        """
        self._field = field
        self._ends = ends
        self._chosen = evenly_chosen(len(ends), BEAMS)
        self._spots = places_with_room(field, 0.9 * body_radius)
        self._headings = np.arange(-math.pi, math.pi, TURN)
        self._at = 0
        self._scores = np.zeros(len(self._spots), np.float32)
        self._best = np.zeros(len(self._spots), np.float32)

    def advance(self) -> bool:
        """Try some more poses; return whether all are tried."""
        count = max(1, PIECE // max(1, len(self._spots)))
        for theta in self._headings[self._at : self._at + count]:
            score_heading(
                self._field.values,
                self._field.place,
                self._ends,
                self._chosen,
                self._spots,
                float(theta),
                WIDTH,
                self._scores,
                self._best,
            )
        self._at += count
        return self._at >= len(self._headings)

    def best(self, most: int) -> NDArray[np.float64]:
        """Return the poses that fit best, float64 [n, 3], x, y, theta, best first."""
        order = np.argsort(-self._scores, kind="stable")[:most]
        order = order[self._scores[order] > 0.0]
        return np.column_stack((self._spots[order], self._best[order].astype(np.float64)))


def places_with_room(field: SurfaceField, room: float) -> NDArray[np.float64]:
    """Return a lattice of places with ``room`` m around them, float64 [n, 2], m."""
    frame = field.frame
    stride = max(1, round(STEP / frame.resolution))
    blocks = -(-frame.rows // stride) * -(-frame.columns // stride)
    cells = np.empty((blocks, 2), np.int64)
    cells = cells[: cells_with_room(field.values, room, stride, cells)]
    return np.column_stack(frame.centres(cells[:, 0], cells[:, 1]))
