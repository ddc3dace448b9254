"""Floor that no way leads to from the station: it is neither cleaned nor missed, but told."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from roomba.commands.trials.homes import rooms_of
from roomba.commands.trials.runs import docking_config, mission_config, robot_config_of
from roomba.commands.trials.trial import Trial
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.rooms.zones import Zones
from roomba.world.home.home import Home

LEAST_TOLD: Final = 1.0
"""m², of all pieces together; no room is smaller, and what is less lies between or behind
furniture: it is not told."""
_HARDLY_ANY: Final = 0.05
"""m²; less is not worth words."""


class Unreached(NamedTuple):
    """How much floor that is, m², in which rooms, if the home has any, and how much elsewhere.

    Rooms in which it is little are not named.
    """

    area: float = 0.0
    rooms: tuple[str, ...] = ()
    elsewhere: float = 0.0

    @property
    def words(self) -> str:
        """It in a line; nothing if there is none."""
        if not self.area:
            return ""
        count = len(self.rooms)
        where = f" in {self.rooms[0] if count == 1 else f'{count} rooms'}" if count else ""
        if count and self.elsewhere >= _HARDLY_ANY:
            where += " and other places"
        return f"{self.area:.1f} m² of floor{where} cannot be reached from the station"

    def as_json(self) -> dict[str, Any]:
        """Return plain values; the area to 1 cm2."""
        return {"area_m2": round(self.area, 4), "rooms": list(self.rooms)}


NOTHING: Final = Unreached()


def unreached_of(home: Home, zones: Zones) -> Unreached:
    """Return that of a home with zones for the shipped robot, as of :func:`unreached_in`."""
    robot = robot_config_of(Trial())
    mission, docking = mission_config(robot), docking_config()
    rooms = rooms_of(home)
    return unreached_in(
        PlanningContext(home.map, home.station, robot, mission, docking, rooms, zones)
    )


def unreached_in(context: PlanningContext) -> Unreached:
    """Return what the tool could sweep from anywhere on the robot's map, but not from its station.

    What lies in a zone that is to be kept out of does not count, what lies behind it does.
    """
    floor = context.floor
    cell = floor.frame.resolution**2
    left = floor.swept_from(floor.fits) & ~context.coverable()
    area = float(np.count_nonzero(left)) * cell
    if area < LEAST_TOLD:
        return NOTHING
    if context.rooms is None:
        return Unreached(area)
    names = np.array(context.rooms.names)
    labels = context.fine(context.rooms.labels)[left]
    counts = np.bincount(labels, minlength=len(names) + 1)[1:]
    is_told = counts * cell >= LEAST_TOLD
    return Unreached(
        area, tuple(names[is_told].tolist()), area - float(counts[is_told].sum()) * cell
    )
