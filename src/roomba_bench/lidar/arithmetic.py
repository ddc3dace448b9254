"""The least that a scan by edge projection has to compute: the floor that no code gets under.

Along one edge 1/r is A·cos(θ) + B·sin(θ). Here each beam is turned with the robot, evaluated once
on an edge that is known beforehand, and inverted. There is no search and no branch.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.arrays import Floats32
from roomba_bench.peers.protocol import Work

_PIECES = 16
"""Edges that a robot sees at once in a furnished room, about."""


def arithmetic(poses: NDArray[np.float64], beams: int) -> Work:
    """Return the work of as many scans as there are poses, float64 [poses, 3]."""
    random = np.random.default_rng(0)
    edges = random.uniform(0.1, 1.0, (len(poses), _PIECES, 2)).astype(np.float32)
    angles = np.arange(beams) * (2.0 * math.pi / beams)
    fan = np.stack([np.cos(angles), np.sin(angles)]).astype(np.float32)
    ranges = np.empty((len(poses), beams), np.float32)

    def work() -> float:
        _evaluate(poses, edges, fan, ranges)
        return float(len(poses))

    return Work(work)


@njit(cache=True, fastmath=True, nogil=True)
def _evaluate(poses: NDArray[np.float64], edges: Floats32, fan: Floats32, ranges: Floats32) -> None:
    beams = ranges.shape[1]
    for scan in range(len(poses)):
        cosine, sine = np.float32(math.cos(poses[scan, 2])), np.float32(math.sin(poses[scan, 2]))
        for piece in range(edges.shape[1]):
            along, across = edges[scan, piece]
            # Turning the edge turns all its beams.
            first = along * cosine + across * sine
            second = across * cosine - along * sine
            for beam in range(
                beams * piece // edges.shape[1], beams * (piece + 1) // edges.shape[1]
            ):
                ranges[scan, beam] = np.float32(1.0) / (
                    first * fan[0, beam] + second * fan[1, beam]
                )
