"""Counts how often the tool passed over each piece of floor, for a picture."""

from __future__ import annotations

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.grid import GridFrame

_PIECE: Final = 10
"""Poses that are drawn at a time."""
_LEAST_AWAY: Final = 3.0
"""s; a robot that comes back sooner still counts as the same pass."""
_SHIFT: Final = 4
"""Fractional bits of OpenCV's fixed-point coordinates."""


def passes_over(
    trajectory: NDArray[np.float64], frame: GridFrame, tool_width: float
) -> NDArray[np.uint8]:
    """Return how often a disc passed each cell, uint8 [rows, columns], up to 255.

    ``trajectory`` has rows t (s), x, y (m), theta, close to each other.
    """
    counts = np.zeros(frame.shape, np.uint8)
    last = np.full(frame.shape, -np.inf, np.float32)
    thickness = max(1, round(tool_width / frame.resolution))
    columns = (trajectory[:, 1] - frame.origin_x) / frame.resolution - 0.5
    rows = (trajectory[:, 2] - frame.origin_y) / frame.resolution - 0.5
    for start in range(0, max(len(trajectory) - 1, 1), _PIECE):
        piece = slice(start, start + _PIECE + 1)
        low_row = max(int(rows[piece].min()) - thickness, 0)
        low_column = max(int(columns[piece].min()) - thickness, 0)
        window = (
            slice(low_row, int(rows[piece].max()) + thickness + 2),
            slice(low_column, int(columns[piece].max()) + thickness + 2),
        )
        mask = np.zeros(counts[window].shape, np.uint8)
        points = np.stack([columns[piece] - low_column, rows[piece] - low_row], axis=1)
        fixed = np.rint(points * (1 << _SHIFT)).astype(np.int32)
        cv2.polylines(mask, [fixed], False, (255,), thickness, cv2.LINE_8, _SHIFT)
        passed = mask > 0
        time = float(trajectory[piece][-1, 0])
        is_new = passed & (time - last[window] > _LEAST_AWAY) & (counts[window] < 255)
        counts[window][is_new] += 1
        last[window][passed] = time
    return counts
