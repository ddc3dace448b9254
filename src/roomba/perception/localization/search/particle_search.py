"""A search for the robot on the whole map while it drives: a particle filter.

One scan does not determine the place in long corridors, and on a map by another program or of
another day hardly any scan fits well. Particles follow all places where the robot may be, until
scans along its way have told these apart.
Source: Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, 8.3 (Monte Carlo localization).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.search.matched import evenly_chosen
from roomba.perception.localization.search.particle_kernels import (
    fill_likelihoods,
    leave_walls,
    move_all,
    normalise,
    resample,
    spread_over,
    weigh_all,
    weight_around,
)
from roomba.perception.localization.search.place_search import places_with_room
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField

_HEADINGS: Final = 24
"""Headings that the search begins with at each place."""
_MOST: Final = 60_000
_LEAST: Final = 20_000
"""Particles after the first scan, at most and at least."""
_EACH: Final = 60
"""Particles for each part of the map where the robot may be; the next two numbers are its size."""
_PART: Final = 0.5
_PART_TURN: Final = 0.35
"""m, rad; the size of such a part."""
_HARDLY: Final = 1e-6
"""Weight of a part up to which the robot is not taken to be there."""
_BEAMS: Final = 60
_FIRST_BEAMS: Final = 20
"""Beams of a scan that are compared; fewer of the first one, as it is tried on the whole map."""
_STEP: Final = 0.2
_TURN: Final = 0.3
"""m, rad; motion after which another scan counts."""
_DEPTH: Final = 2.0
_MOST_DEPTH: Final = 0.2
"""Cells, and m at most: how deep in a wall beams may end, as maps draw walls too thick."""
_SPREAD: Final = 0.2
"""m; standard deviation of where beams end, as maps by other programs or of other days are off."""
_CHANCE: Final = 0.1
"""Likelihood, against that of a perfect hit, of a beam that ends anywhere else."""
_SHARE: Final = 0.05
"""Weight of one beam. Errors of a map are the same for neighbours, and over half a metre of way."""
_WAY_NOISE: Final = np.array([0.1, 0.05, 0.06])
_TURN_NOISE: Final = 0.1
_NOISE: Final = np.array([0.02, 0.01, 0.01])
"""Standard deviations of the motion, ahead, aside (m) and turned (rad): for each m of way; of the
turn for each rad turned; and those that a robot has that stands.
"""
_NEAR: Final = 0.7
_TURNED: Final = 0.4
"""m, rad; particles nearer to each other than both are of the same place."""
_SURE: Final = 0.98
_SURE_WAY: Final = 4.0
"""Share of all weight that one place must have, over so many m of way, to be believed."""
_HIT: Final = 0.2
_HITS: Final = 0.6
"""m; a beam that ends nearer than this to a surface has hit it. The share of beams that must hit on
average over that way, for a place to be believed: on a map of another home no place has it.
"""


class ParticleSearch:
    """One search; tell it each scan. ``reckoned`` poses are those of DeadReckoning."""

    def __init__(self, field: SurfaceField, body_radius: float) -> None:
        """Begin with a robot of ``body_radius`` m that may be anywhere on the map."""
        self._field, self._place = field, field.place
        self._depth = min(_DEPTH * field.frame.resolution, _MOST_DEPTH)
        self._likelihoods = np.empty_like(field.values)
        fill_likelihoods(field.values, self._depth, _SPREAD, _CHANCE, self._likelihoods)
        self._room = 0.5 * body_radius
        spots = places_with_room(field, self._room)
        self._particles = np.empty((len(spots) * _HEADINGS, 4))
        spread_over(spots, _HEADINGS, self._particles)
        self._random = np.random.default_rng(0)
        self._reckoned: Pose | None = None
        self._middle = np.zeros(3)
        self._sure_way = self._hits = 0.0

    @property
    def found(self) -> Pose | None:
        """Where the robot was at the newest scan that counted; None if that is not sure."""
        if self._sure_way < _SURE_WAY or self._hits < _HITS:
            return None
        x, y, theta = self._middle.tolist()
        return Pose(x, y, wrap_angle(theta))

    @property
    def reckoned(self) -> Pose:
        """Where dead reckoning was at the newest scan that counted."""
        return self._reckoned or Pose()

    def see(self, view: ScanView, reckoned: Pose) -> None:
        """Compare all places by a scan; it counts when the robot has moved since the last."""
        step = Pose() if self._reckoned is None else self._reckoned.inverse().compose(reckoned)
        way = math.hypot(step.x, step.y)
        if self._reckoned is not None:
            if way < _STEP and abs(step.theta) < _TURN:
                return
            self._move(step, way)
        beams = _FIRST_BEAMS if self._reckoned is None else _BEAMS
        chosen = evenly_chosen(len(view), beams)
        weigh_all(
            self._likelihoods,
            self._place,
            view.ends,
            chosen,
            _SHARE * _BEAMS / beams,
            math.log(_CHANCE),
            self._particles,
        )
        self._reckoned = reckoned
        leave_walls(self._field.values, self._place, 0.0, self._particles)
        self._sum_up(view, way)

    def _move(self, step: Pose, way: float) -> None:
        deviations = _NOISE + _WAY_NOISE * way
        deviations[2] += _TURN_NOISE * abs(step.theta)
        noise = self._random.standard_normal((len(self._particles), 3)) * deviations
        move_all(self._particles, step.x, step.y, step.theta, noise)

    def _sum_up(self, view: ScanView, way: float) -> None:
        """Find the likeliest place; resample if few particles have weight, or too many exist."""
        weights = np.empty(len(self._particles))
        worth = normalise(self._particles, weights)
        if worth == 0.0:
            # All particles drove into walls: the robot is at none of the places that were followed.
            self._begin_again()
            return
        parts, part = self._parts(weights)
        best = self._particles[int(np.argmax(np.where(parts == part.argmax(), weights, 0.0))), :3]
        share = weight_around(self._particles, weights, best.copy(), _NEAR, _TURNED, self._middle)
        self._judge(view, way, share)
        if worth < 0.5 * len(self._particles) or len(self._particles) > _MOST:
            wanted = _EACH * int(np.count_nonzero(part > _HARDLY))
            chosen = np.empty((max(_LEAST, min(_MOST, wanted)), 4))
            resample(self._particles, weights, float(self._random.random()), chosen)
            self._particles = chosen

    def _parts(self, weights: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return the part of the map that each particle is in, and the weight of each part."""
        frame, poses = self._field.frame, self._particles
        column = np.floor((poses[:, 0] - frame.origin_x) / _PART).astype(np.int64)
        row = np.floor((poses[:, 1] - frame.origin_y) / _PART).astype(np.int64)
        heading = np.floor(np.mod(poses[:, 2], 2.0 * math.pi) / _PART_TURN).astype(np.int64)
        columns = int(frame.columns * frame.resolution / _PART) + 2
        headings = int(2.0 * math.pi / _PART_TURN) + 1
        number = (np.clip(row, 0, None) * columns + np.clip(column, 0, columns - 1)) * headings
        number += np.minimum(heading, headings - 1)
        return number, np.bincount(number, weights).astype(np.float64)

    def _judge(self, view: ScanView, way: float, share: float) -> None:
        """Sum up the way on which one place has nearly all weight, and how well scans fit there."""
        hits = self._hit_share(view)
        if share < _SURE:
            self._sure_way, self._hits = 0.0, hits
            return
        self._sure_way += way
        self._hits += (hits - self._hits) * min(1.0, way / _SURE_WAY)

    def _hit_share(self, view: ScanView) -> float:
        """Return the share of beams that end near a surface at the likeliest place."""
        ends = view.ends_at(Pose(*self._middle.tolist())).astype(np.float64)
        rows, columns = self._field.frame.cells_of(ends[:, 0], ends[:, 1])
        inside = self._field.frame.holds(rows, columns)
        off = self._field.values[rows[inside], columns[inside]]
        hit = np.count_nonzero((off < _HIT) & (off > -self._depth - _HIT))
        return hit / max(1, len(ends))

    def _begin_again(self) -> None:
        spots = places_with_room(self._field, self._room)
        self._particles = np.empty((len(spots) * _HEADINGS, 4))
        spread_over(spots, _HEADINGS, self._particles)
        self._sure_way = self._hits = 0.0
