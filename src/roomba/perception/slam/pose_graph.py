"""The pose graph: the poses that agree best, in least squares, with measurements between them.

Gauss and Newton's method on the sum of squared, weighted errors (Lu and Milios, "Globally
consistent range scan alignment", 1997). The first pose stays where it is. Homes have some dozens
of submaps, so the normal equations are solved as a dense matrix.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles

Floats = NDArray[np.float64]

_ROUNDS: Final = 12
_SETTLED: Final = 1e-5
"""m and rad; corrections that are smaller end the search."""
_DOUBTED: Final = 9.0
"""Squared error, in deviations, of which a link loses three quarters of its weight."""


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """A measurement: the pose of ``child`` in the frame of ``parent``.

    ``relative`` is float64 [3], x, y, theta; ``information`` float64 [3, 3], the inverse of its
    covariance. A link that ``may_be_wrong`` loses weight when all others contradict it.
    """

    parent: int
    child: int
    relative: Floats
    information: Floats
    may_be_wrong: bool = True


def relative_to(parents: Floats, children: Floats) -> Floats:
    """Return poses, float64 [n, 3], in the frames of others, [n, 3] as well."""
    away = children - parents
    cosine, sine = np.cos(parents[:, 2]), np.sin(parents[:, 2])
    return np.column_stack(
        (
            cosine * away[:, 0] + sine * away[:, 1],
            cosine * away[:, 1] - sine * away[:, 0],
            wrap_angles(away[:, 2]),
        )
    )


def composed(parents: Floats, relative: Floats) -> Floats:
    """Return where poses, float64 [n, 3], lie that are given in the frames of others, [n, 3]."""
    cosine, sine = np.cos(parents[:, 2]), np.sin(parents[:, 2])
    return np.column_stack(
        (
            parents[:, 0] + cosine * relative[:, 0] - sine * relative[:, 1],
            parents[:, 1] + sine * relative[:, 0] + cosine * relative[:, 1],
            wrap_angles(parents[:, 2] + relative[:, 2]),
        )
    )


def optimised(poses: Floats, links: list[Link]) -> Floats:
    """Return ``poses``, float64 [n, 3], moved so that they agree best with the links.

    Raises ValueError for a link between poses that do not exist.
    """
    if not links:
        return poses.copy()
    parents = np.array([link.parent for link in links])
    children = np.array([link.child for link in links])
    if min(parents.min(), children.min()) < 0 or max(parents.max(), children.max()) >= len(poses):
        raise ValueError(f"expected links between poses 0 to {len(poses) - 1}, got others")
    measured = np.array([link.relative for link in links])
    information = np.array([link.information for link in links])
    doubted = np.array([link.may_be_wrong for link in links])
    result = poses.copy()
    for _ in range(_ROUNDS):
        step = _step(result, parents, children, measured, information, doubted)
        result[1:] += step
        result[:, 2] = wrap_angles(result[:, 2])
        if not len(step) or np.abs(step).max() < _SETTLED:
            break
    return result


def _step(
    poses: Floats,
    parents: NDArray[np.int64],
    children: NDArray[np.int64],
    measured: Floats,
    information: Floats,
    doubted: NDArray[np.bool_],
) -> Floats:
    """Return the correction of all poses but the first, float64 [n - 1, 3]."""
    predicted = relative_to(poses[parents], poses[children])
    error = predicted - measured
    error[:, 2] = wrap_angles(error[:, 2])
    square = np.einsum("ni,nij,nj->n", error, information, error)
    weight = np.where(doubted, (_DOUBTED / (_DOUBTED + square)) ** 2, 1.0)
    weighted = information * weight[:, None, None]
    of_parent, of_child = _slopes(poses[parents], predicted)
    count, axes = len(poses), np.arange(3)
    matrix = np.zeros((3 * count, 3 * count))
    gradient = np.zeros((count, 3))
    for slopes, nodes in ((of_parent, parents), (of_child, children)):
        np.add.at(gradient, nodes, np.einsum("nki,nkl,nl->ni", slopes, weighted, error))
        for others, beside in ((of_parent, parents), (of_child, children)):
            block = np.einsum("nki,nkl,nlj->nij", slopes, weighted, others)
            rows = (3 * nodes[:, None] + axes)[:, :, None]
            columns = (3 * beside[:, None] + axes)[:, None, :]
            np.add.at(matrix, (rows, columns), block)
    size = 3 * (count - 1)
    left = matrix[3:, 3:]
    # A pose that no link holds stays where it is.
    left[np.diag_indices(size)] += 1e-6
    return -np.linalg.solve(left, gradient[1:].reshape(size)).reshape(-1, 3)


def _slopes(parents: Floats, predicted: Floats) -> tuple[Floats, Floats]:
    """Return how the predicted measurements change with the parents' and the children's poses."""
    cosine, sine = np.cos(parents[:, 2]), np.sin(parents[:, 2])
    count = len(parents)
    of_child, of_parent = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
    of_child[:, 0, 0], of_child[:, 0, 1] = cosine, sine
    of_child[:, 1, 0], of_child[:, 1, 1] = -sine, cosine
    of_child[:, 2, 2] = 1.0
    of_parent[:] = -of_child
    of_parent[:, 0, 2], of_parent[:, 1, 2] = predicted[:, 1], -predicted[:, 0]
    return of_parent, of_child
