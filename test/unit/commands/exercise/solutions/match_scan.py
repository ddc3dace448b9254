"""Least squares of distances to surfaces, read between the middles of cells."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt, map_coordinates
from scipy.optimize import least_squares


def matched_pose(
    ranges: Any, angles: Any, solid: Any, resolution: float, origin: Any, guess: Any
) -> Any:
    outside, inside = distance_transform_edt(~solid), distance_transform_edt(solid)
    field = (np.where(solid, 0.5 - inside, outside - 0.5)) * resolution
    met = np.isfinite(ranges)
    ranges, angles = ranges[met], angles[met]

    def off(pose: Any) -> Any:
        x = pose[0] + ranges * np.cos(angles + pose[2])
        y = pose[1] + ranges * np.sin(angles + pose[2])
        places = [(y - origin[1]) / resolution - 0.5, (x - origin[0]) / resolution - 0.5]
        return map_coordinates(field, places, order=1, mode="nearest")

    return least_squares(off, guess, loss="soft_l1", f_scale=0.02).x
