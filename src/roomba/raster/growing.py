"""Compiled growth of arrays whose length shows while they are filled.

Rows are copied number by number. To assign a slice would compile, into each caller, the words of
an error that cannot come: that took longer than all the rest of a caller.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import allocating_part


@allocating_part
def with_room(rows: NDArray[Any], size: int, room: int) -> NDArray[Any]:
    """Return an array [room, columns] that begins with the first ``size`` of ``rows``."""
    larger = np.empty((room, rows.shape[1]), rows.dtype)
    for row in range(size):
        for column in range(rows.shape[1]):
            larger[row, column] = rows[row, column]
    return larger
