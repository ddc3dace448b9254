"""Where a seed puts round things that the map does not show."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.commands.options import UsageError
from roomba.geometry import Pose, RoundObstacle
from roomba.world.home.home import Home
from roomba.world.home.raster import where_body_fits

_STREAM: Final = 20_021
"""A stream of the seed's random numbers, so that they differ from those of noise."""
_LEAST, _MOST = 0.04, 0.14
"""m; radius of a thing: from a drinking glass to a pile of books."""
_FROM_STATION: Final = 1.2
"""m; no thing stands nearer to the station."""


def seeded_things(
    home: Home, staging: Pose, floor: Mask, count: int, seed: int
) -> list[RoundObstacle]:
    """Return round things on ``floor``, bool over the home's grid, that touch nothing else.

    Raises UsageError for a floor that has no room for so many.
    """
    random = np.random.default_rng([_STREAM, seed])
    things: list[RoundObstacle] = []
    for _ in range(count):
        radius = float(random.uniform(_LEAST, _MOST))
        places = floor & where_body_fits(home.frame, home.solid | home.drop, radius)
        rows, columns = np.nonzero(places)
        x, y = home.frame.centres(rows, columns)
        allowed = np.ones(len(x), np.bool_)
        for at in (home.station, staging):
            allowed &= np.hypot(x - at.x, y - at.y) > _FROM_STATION
        for other_x, other_y, other in things:
            allowed &= np.hypot(x - other_x, y - other_y) > radius + other + 0.05
        if not allowed.any():
            raise UsageError(
                f"--things: expected a floor with room for {count}, got room for {len(things)}; "
                "ask for fewer"
            )
        chosen = int(random.choice(np.flatnonzero(allowed)))
        things.append((float(x[chosen]), float(y[chosen]), round(radius, 4)))
    return things
