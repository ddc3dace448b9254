"""The pose graph: the poses that agree best, in least squares, with measurements between them.

The Gauss-Newton method on the sum of squared, weighted errors (Lu and Milios, "Globally
consistent range scan alignment", 1997). The first pose stays where it is. Homes have some dozens
of submaps: few normal equations are solved as a dense matrix, many as a sparse one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats

Indices = NDArray[np.int64]

_ROUNDS: Final = 30
_SETTLED: Final = 1e-5
"""m and rad; smaller corrections end the iteration."""
_DOUBTED: Final = 9.0
"""Tolerance at last: squared error, in variances, at which a link loses 3/4 of its weight."""
_LAST_ROUNDS: Final = 8
"""Rounds, at most, once the tolerance is down to this last one."""
_STRICTER: Final = 0.1
"""Factor on the tolerance in each round. It is larger at first, so that links can pull poses
together that are far off (graduated non-convexity: Yang et al., RA-L 2020)."""
_DENSE: Final = 600
"""Unknowns; for more of them a sparse matrix is quicker."""
_HELD: Final = 1e-6
"""1/m2; information that keeps a pose in place that no link holds."""


class LinkKind(Enum):
    """How a link between two submaps was measured."""

    MATCHED = "matched"
    """By matching their scans, which show the same walls. It may be wrong, as places look alike."""
    DRIVEN = "driven"
    """By following the robot from one submap to the next."""
    GUESSED = "guessed"
    """By dead reckoning, or less, from one submap to the next: no scan confirmed the way."""
    TOLD = "told"
    """A reported pose: that of the child on the map, seen from the submap nearest to it."""


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """A measurement: the pose of ``child`` in the frame of ``parent``.

    ``relative`` is float64 [3], x, y, theta; ``information`` float64 [3, 3], the inverse of its
    covariance.
    """

    parent: int
    child: int
    relative: Floats
    information: Floats
    kind: LinkKind = LinkKind.MATCHED

    @property
    def may_be_wrong(self) -> bool:
        """Whether the link loses weight if the others contradict it."""
        return self.kind is LinkKind.MATCHED


class Measurements(NamedTuple):
    """Links as arrays: ``parents``, ``children`` and ``doubted`` are [m], ``relative`` [m, 3],
    ``information`` [m, 3, 3].
    """

    parents: Indices
    children: Indices
    relative: Floats
    information: Floats
    doubted: NDArray[np.bool_]

    def beside(self, others: Measurements) -> Measurements:
        """Return these links, followed by others."""
        return Measurements(*(np.concatenate(both) for both in zip(self, others, strict=True)))

    @staticmethod
    def of(links: list[Link]) -> Measurements:
        """Return links as arrays."""
        return Measurements(
            np.array([link.parent for link in links]),
            np.array([link.child for link in links]),
            np.array([link.relative for link in links]),
            np.array([link.information for link in links]),
            np.array([link.may_be_wrong for link in links]),
        )


def relative_to(parents: Floats, children: Floats) -> Floats:
    """Return poses, float64 [n, 3], in the frames of others, [n, 3] as well."""
    away = children - parents
    cosine, sine = np.cos(parents[:, 2]), np.sin(parents[:, 2])
    relative = np.empty(away.shape)
    relative[:, 0] = cosine * away[:, 0] + sine * away[:, 1]
    relative[:, 1] = cosine * away[:, 1] - sine * away[:, 0]
    relative[:, 2] = wrap_angles(away[:, 2])
    return relative


def composed(parents: Floats, relative: Floats) -> Floats:
    """Return where poses, float64 [n, 3], lie that are given in the frames of others, [n, 3]."""
    cosine, sine = np.cos(parents[:, 2]), np.sin(parents[:, 2])
    placed = np.empty(relative.shape)
    placed[:, 0] = parents[:, 0] + cosine * relative[:, 0] - sine * relative[:, 1]
    placed[:, 1] = parents[:, 1] + sine * relative[:, 0] + cosine * relative[:, 1]
    placed[:, 2] = wrap_angles(parents[:, 2] + relative[:, 2])
    return placed


def inverse(pose: Floats) -> Floats:
    """Return the inverse of a pose [3]."""
    undone: Floats = relative_to(pose[None], np.zeros((1, 3)))[0]
    return undone


def optimised(poses: Floats, links: list[Link], known: int = 0) -> Floats:
    """Return ``poses``, float64 [n, 3], moved so that they agree best with the links.

    The poses were optimised before for the first ``known`` links. Raises ValueError for a link
    between poses that do not exist.
    """
    if len(links) <= known:
        return poses.copy()
    return brought_to_agree(poses, Measurements.of(links), known)


def brought_to_agree(poses: Floats, measured: Measurements, known: int = 0) -> Floats:
    """Return the same as :func:`optimised`, for links as arrays; there must be at least one."""
    ends = measured.parents, measured.children
    if min(end.min() for end in ends) < 0 or max(end.max() for end in ends) >= len(poses):
        raise ValueError(f"expected links between poses 0 to {len(poses) - 1}, got others")
    result = poses.copy()
    tolerance, left = math.inf, _LAST_ROUNDS
    for _ in range(_ROUNDS):
        errors = _errors(result, measured)
        worst = float(errors.square[known:][measured.doubted[known:]].max(initial=0.0))
        tolerance = max(_DOUBTED, min(_STRICTER * tolerance, worst))
        weighted = _weighted(measured, errors, tolerance)
        step = _step(result, measured, errors, weighted)
        result[1:] += step
        result[:, 2] = wrap_angles(result[:, 2])
        is_settled = not len(step) or np.abs(step).max() < _SETTLED
        left -= tolerance == _DOUBTED
        if (is_settled and tolerance == _DOUBTED) or left == 0:
            break
    return result


class _Errors(NamedTuple):
    """The ``error`` of each link, [m, 3], the measurement ``predicted`` by the poses, [m, 3], and
    the ``square`` of the error, in variances, [m].
    """

    error: Floats
    predicted: Floats
    square: Floats


class _Matrix(NamedTuple):
    """A sparse matrix: the sum of ``values`` [k] at ``rows`` and ``columns``, int64 [k] each."""

    rows: Indices
    columns: Indices
    values: Floats


def _errors(poses: Floats, measured: Measurements) -> _Errors:
    predicted = relative_to(poses[measured.parents], poses[measured.children])
    error = predicted - measured.relative
    error[:, 2] = wrap_angles(error[:, 2])
    square = (error[:, None] @ measured.information @ error[:, :, None])[:, 0, 0]
    return _Errors(error, predicted, square)


def _weighted(measured: Measurements, errors: _Errors, tolerance: float) -> Floats:
    """Return the information [m, 3, 3] of the links, reduced for links that others contradict."""
    trust = (tolerance / (tolerance + errors.square)) ** 2
    weighted: Floats = measured.information * np.where(measured.doubted, trust, 1.0)[:, None, None]
    return weighted


def _step(poses: Floats, measured: Measurements, errors: _Errors, weighted: Floats) -> Floats:
    """Return the correction of all poses but the first, float64 [n - 1, 3]."""
    slopes = _slopes(poses, measured, errors.predicted)
    gradient = np.zeros((len(poses), 3))
    for of_end, nodes in zip(slopes, (measured.parents, measured.children), strict=True):
        pull = of_end.transpose(0, 2, 1) @ (weighted @ errors.error[:, :, None])
        np.add.at(gradient, nodes, pull[:, :, 0])
    matrix = _normal_equations(measured, slopes, weighted)
    return _solved(matrix, -gradient.reshape(-1)).reshape(-1, 3)[1:]


def _normal_equations(
    measured: Measurements, slopes: tuple[Floats, Floats], weighted: Floats
) -> _Matrix:
    axes = np.arange(3)
    ends = tuple(zip(slopes, (measured.parents, measured.children), strict=True))
    rows, columns, values = [], [], []
    for of_end, nodes in ends:
        for others, beside in ends:
            block = of_end.transpose(0, 2, 1) @ (weighted @ others)
            row = (3 * nodes[:, None] + axes)[:, :, None]
            column = (3 * beside[:, None] + axes)[:, None, :]
            rows.append(np.broadcast_to(row, block.shape).ravel())
            columns.append(np.broadcast_to(column, block.shape).ravel())
            values.append(block.ravel())
    return _Matrix(np.concatenate(rows), np.concatenate(columns), np.concatenate(values))


def _solved(sums: _Matrix, right: Floats) -> Floats:
    """Return the solution of the normal equations, float64 [n], whose first three are 0."""
    size = right.size
    solution = np.zeros(size)
    if size <= _DENSE:
        matrix = np.zeros((size, size))
        np.add.at(matrix, (sums.rows, sums.columns), sums.values)
        left = matrix[3:, 3:]
        left[np.diag_indices(size - 3)] += _HELD
        solution[3:] = np.linalg.solve(left, right[3:])
        return solution
    # Imported only here: it takes 40 MB, and only large maps need it.
    from scipy.sparse import csc_matrix, identity
    from scipy.sparse.linalg import spsolve

    sparse = csc_matrix((sums.values, (sums.rows, sums.columns)), shape=(size, size))[3:, 3:]
    sparse = (sparse + _HELD * identity(size - 3, format="csc")).tocsc()
    solution[3:] = spsolve(sparse, right[3:], permc_spec="MMD_AT_PLUS_A")
    return solution


def _slopes(poses: Floats, measured: Measurements, predicted: Floats) -> tuple[Floats, Floats]:
    """Return how predictions change with the poses of parents and of children, [m, 3, 3] each."""
    headings = poses[measured.parents, 2]
    cosine, sine, count = np.cos(headings), np.sin(headings), len(headings)
    of_child, of_parent = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
    of_child[:, 0, 0], of_child[:, 0, 1] = cosine, sine
    of_child[:, 1, 0], of_child[:, 1, 1] = -sine, cosine
    of_child[:, 2, 2] = 1.0
    of_parent[:] = -of_child
    of_parent[:, 0, 2], of_parent[:, 1, 2] = predicted[:, 1], -predicted[:, 0]
    return of_parent, of_child
