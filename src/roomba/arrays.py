"""Types of arrays that many modules speak of: a name tells the type of the numbers everywhere.

Shapes, units and frames are told where an array is.
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
"""Which cells are meant."""
