"""A mirror on the map: its plane, and how far it reaches to both sides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.perception.slam.mirrors.images import Beams, MappedFloor, Plane, images, places_of_ends
from roomba.perception.slam.submaps.pose_graph import composed

_BIN: Final = 0.05
"""m; length of a bin along a mirror."""
_BINS: Final = 61
"""Bins to either side of where a mirror was found: 3 m."""
_GAP: Final = 3
"""Bins without fitting images over which a mirror still goes on."""
_TO_SURFACE: Final = 6
"""Bins over which a mirror goes on to a surface beside it: no robot fits through such a gap."""
_LEAST: Final = 3
"""Images that must fit, in a bin and the two beside it, for the mirror to be there."""
_FOUND: Final = 1
"""Bins to either side of where a mirror was found that are mirror in any case."""
_LEAST_REACH: Final = ((_FOUND + 0.5) * _BIN, (_FOUND + 0.5) * _BIN)
"""m to the right and to the left that are mirror in any case."""


@dataclass(slots=True, eq=False)
class Mirror:
    """A mirror in the frame of a submap, with whose keyframes it moves.

    ``plane`` is that of the mirror, its middle where the mirror was found. From there the mirror
    reaches at least ``least``, m, to the right and to the left. ``fits`` and ``contradicts`` count
    beams by where they passed the plane, ``met`` those that met a surface on it. The first
    ``counted`` keyframes of the map are counted. The robot saw itself in the mirror from
    ``seen_from`` m away on; 0 means that it touched the mirror.
    """

    submap: int
    plane: Plane
    least: tuple[float, float]
    fits: NDArray[np.int64]
    contradicts: NDArray[np.int64]
    met: NDArray[np.int64]
    counted: int = 0
    seen_from: float = 0.0

    @staticmethod
    def found(submap: int, plane: Plane, seen_from: float = 0.0) -> Mirror:
        """Return a mirror of which only one point on its plane is known."""
        fits, contradicts, met = np.zeros((3, 2 * _BINS + 1), np.int64)
        return Mirror(
            submap, plane, _LEAST_REACH, fits, contradicts, met, counted=0, seen_from=seen_from
        )

    @staticmethod
    def of(kept: KeptMirror) -> Mirror:
        """Return a mirror that was saved; it keeps its reach until its beams are counted."""
        right, left = kept.reach.tolist()
        mirror = Mirror.found(kept.submap, Plane(*kept.plane.tolist()), kept.seen_from)
        return replace(mirror, least=(right, left))

    @property
    def kept(self) -> KeptMirror:
        """The part of the mirror that is saved."""
        return KeptMirror(self.submap, np.array(self.plane), np.array(self.reach), self.seen_from)

    @property
    def reach(self) -> tuple[float, float]:
        """How far the mirror reaches to the right and to the left of its plane's middle, m."""
        return max(self.least[0], self._reach(-1)), max(self.least[1], self._reach(1))

    def ends(self, pose: Floats) -> Floats:
        """Return the mirror's right and left end, float64 [2, 2], m; its submap is at ``pose``."""
        plane, (right, left) = placed(self.plane, pose), self.reach
        return plane.middle + np.outer((-right, left), plane.along)

    def forget(self) -> None:
        """Forget all counts of beams, to count them anew."""
        self.least = _LEAST_REACH
        for counts in (self.fits, self.contradicts, self.met):
            counts[:] = 0

    def count(self, beams: Beams, floor: MappedFloor, pose: Floats) -> None:
        """Count beams at the mirror; its submap is at ``pose`` [3]."""
        plane = placed(self.plane, pose)
        seen = images(beams, plane, floor)
        _count(self.fits, seen.places[seen.informs & seen.fits])
        _count(self.contradicts, seen.places[seen.informs & seen.contradicts])
        _count(self.met, places_of_ends(beams, plane))

    def _reach(self, step: int) -> float:
        """Return how far images fit to one side of the middle, m, or how far a surface is there."""
        fits, contradicts = _with_beside(self.fits), _with_beside(self.contradicts)
        last = 0
        for at in range(1, _BINS + 1):
            fitting, against = fits[_BINS + step * at], contradicts[_BINS + step * at]
            if against > fitting or at - last > _TO_SURFACE:
                break
            if fitting >= _LEAST and at - last <= _GAP:
                last = at
            elif self.met[_BINS + step * at] >= _LEAST:
                last = at
                break
        return (last + 0.5) * _BIN


class KeptMirror(NamedTuple):
    """A mirror as it is remembered: ``plane`` float64 [3], ``reach`` float64 [2], right and left,
    m, in the frame of a submap, by its number; ``seen_from`` as :class:`Mirror` has it.
    """

    submap: int
    plane: Floats
    reach: Floats
    seen_from: float = 0.0


def placed(plane: Plane, pose: Floats) -> Plane:
    """Return where a plane lies, given in a frame that is at ``pose``, float64 [3]."""
    return Plane(*composed(pose[None], np.array(plane)[None])[0].tolist())


def _count(counts: NDArray[np.int64], places: Floats) -> None:
    """Count beams by where along a mirror, m, they pass or end."""
    bins = np.floor(places / _BIN + 0.5).astype(np.int64) + _BINS
    bins = bins[(bins >= 0) & (bins < len(counts))]
    counts += np.bincount(bins, minlength=len(counts))


def _with_beside(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the sum of each bin and its two neighbours."""
    return np.convolve(counts, np.ones(3, np.int64), mode="same")
