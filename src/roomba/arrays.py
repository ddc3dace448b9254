"""Types of arrays that many modules speak of: a name tells the type of the numbers everywhere.

Where an array is used, its documentation tells its shape, units and frame.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Polyline = Floats
"""The points of a line, [n, 2]."""
Floats32 = NDArray[np.float32]
Ints32 = NDArray[np.int32]
Ints64 = NDArray[np.int64]
Mask = NDArray[np.bool_]
"""True in each cell that is meant."""
