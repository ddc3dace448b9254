"""Where a map's walls lie in their cells: mapping programs differ in that, and scans show it."""

from __future__ import annotations

from typing import Final

from roomba.geometry import Pose
from roomba.perception.localization.belief.belief import Rows
from roomba.perception.localization.search.matched import matched
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField

_LEAST_OFFSET: Final = 0.15
"""Cells of the map; walls that are off by less stay where they are."""
_LEAST_OFFSET_BEAMS: Final = 100.0
"""Beams that the offset must rest on; a scan counts as far as it shows something new."""
_MOST_OFFSET: Final = 2.0
"""Cells that walls are moved at most: some programs draw walls thicker than they are."""


class LearnedWalls:
    """Moves the surfaces of ``field`` to where scans show the walls.

    How far the walls are off is summed up in ``wall_offset`` of a belief.
    """

    def __init__(self, field: SurfaceField, belief: Rows) -> None:
        """Begin with the walls of the map; forget what ``belief`` learned of another map."""
        self.field = field
        self._row, self._moved = belief[0], 0.0
        self._row["wall_offset"] = 0.0

    def learn(self) -> None:
        """Move the surfaces by the offset that the belief has learned, if it is large and sure."""
        off, beams = self._row["wall_offset"].tolist()
        cell = self.field.frame.resolution
        if beams < _LEAST_OFFSET_BEAMS or abs(off) < _LEAST_OFFSET * cell * beams:
            return
        most = _MOST_OFFSET * cell
        self._move(max(-0.5 * cell, min(most, self._moved - off / beams)))

    def find(self, view: ScanView, pose: Pose, deviation: float) -> Pose:
        """Move the surfaces to where a scan from about ``pose`` fits best; return the matched pose.

        Poses are in the map frame; ``deviation`` is that of a beam, m.
        """
        cell, tried = self.field.frame.resolution, []
        for moved in (0.5 * cell * number for number in range(int(2 * _MOST_OFFSET) + 1)):
            self._move(moved)
            tried.append((*matched(view, self.field, pose, deviation), moved))
        there, _, moved = max(tried, key=lambda each: each[1].evidence)
        self._move(moved)
        return there

    def _move(self, moved: float) -> None:
        """Move the surfaces to ``moved`` m inside of what the map shows as solid."""
        self.field.raise_by(moved - self._moved)
        self._moved = moved
        self._row["wall_offset"][0] = 0.0
