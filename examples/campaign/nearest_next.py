"""A stage of coverage planning of one's own: after each line the one that begins nearest to it.

Ours searches for a short round trip. This one never looks ahead, and shows what that is worth:
``./roomba campaign examples/campaign/planning.yaml``.
"""

from __future__ import annotations

import numpy as np

from roomba.arrays import Floats, Polyline
from roomba.configuration.coverage import CoverageConfig


def order(
    net: object, lines: list[Polyline], first: Floats, last: Floats | None, config: CoverageConfig
) -> list[Polyline]:
    """Return all ``lines``, float64 [n, 2], in the order and direction in which they are driven.

    The way begins at ``first``, float64 [2]. Places in cells; distances as the crow flies.
    """
    left, at, ordered = list(lines), first, []
    while left:
        to_begins = [float(np.hypot(*(line[0] - at))) for line in left]
        to_ends = [float(np.hypot(*(line[-1] - at))) for line in left]
        nearest = int(np.argmin(np.minimum(to_begins, to_ends)))
        line = left.pop(nearest)
        if to_ends[nearest] < to_begins[nearest]:
            line = line[::-1].copy()
        ordered.append(line)
        at = line[-1]
    return ordered
