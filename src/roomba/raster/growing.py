"""Compiled growth of arrays whose length is only known once they are filled.

Rows are copied number by number. Assigning a slice would compile the message of an error that
cannot occur into each caller, which took longer than compiling all the rest of the caller.
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
