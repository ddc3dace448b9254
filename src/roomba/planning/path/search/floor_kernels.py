"""Compiled survey of the floor: where a shortest path can run, and the centres where it can bend.

Lengths in cells; x counts columns, y rows, (0, 0) is the centre of the first cell of the padded
grid, whose border does not fit. The *floor* is all that the body's middle may enter: the straight
steps between neighbouring centres that fit, and the unit squares whose four corners are such
centres (``open_squares[y, x]`` is the one from (x, y) to (x+1, y+1)). A shortest path bends only at
corners of the floor, at centres that fit, so walls and thin passages keep their exact clearance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry

Bytes = NDArray[np.uint8]

BEND = (1, 2, 4, 8)
"""Flags of a centre: a path may bend around the closed square to its NE, NW, SW, SE."""
CROSSING = 16
"""Flag of a centre where the floor is as thin as a line or a point: all ways are tried from it."""
EXIT = 32
"""Flag of a centre from which a straight way leads to the goal."""
SIDE_X = (1, -1, -1, 1)
SIDE_Y = (1, 1, -1, -1)


@entry
def survey(fits: Bytes, open_squares: Bytes, flags: Bytes) -> None:
    """Fill ``open_squares`` and ``flags`` from ``fits``; all uint8 [rows, columns], border 0."""
    rows, columns = fits.shape
    for y in range(rows - 1):
        for x in range(columns - 1):
            open_squares[y, x] = fits[y, x] & fits[y, x + 1] & fits[y + 1, x] & fits[y + 1, x + 1]
    for y in range(1, rows - 1):
        for x in range(1, columns - 1):
            if not fits[y, x]:
                flags[y, x] = 0
                continue
            ne, nw = open_squares[y, x], open_squares[y, x - 1]
            se, sw = open_squares[y - 1, x], open_squares[y - 1, x - 1]
            if ne & nw & se & sw:
                flags[y, x] = 0
                continue
            found = 0
            if nw and se:
                found |= (0 if ne else 1) | (0 if sw else 4)
            if ne and sw:
                found |= (0 if nw else 2) | (0 if se else 8)
            if (
                found == 5
                or found == 10
                or (fits[y, x + 1] and not (ne or se))
                or (fits[y, x - 1] and not (nw or sw))
                or (fits[y + 1, x] and not (ne or nw))
                or (fits[y - 1, x] and not (se or sw))
            ):
                found |= CROSSING
            flags[y, x] = found
