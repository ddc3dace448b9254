"""Floor to which no way leads from the station: it counts neither as cleaned nor as missed."""

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
"""m² of all unreached floor together, from which it is reported: no room is smaller, and smaller
pieces lie between or behind furniture."""
_HARDLY_ANY: Final = 0.05
"""m²; less floor in a room is not worth a mention."""


class Unreached(NamedTuple):
    """Unreached floor: its area, m², its rooms, if the home has any, and its area elsewhere.

    Rooms with hardly any of it are not named.
    """

    area: float = 0.0
    rooms: tuple[str, ...] = ()
    elsewhere: float = 0.0

    @property
    def words(self) -> str:
        """The unreached floor as a line of text; empty if there is none."""
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
    """Return the unreached floor of a home with zones for the shipped robot.

    See :func:`unreached_in`.
    """
    robot = robot_config_of(Trial())
    mission, docking = mission_config(robot), docking_config()
    rooms = rooms_of(home)
    return unreached_in(
        PlanningContext(home.map, home.station, robot, mission, docking, rooms, zones)
    )


def unreached_in(context: PlanningContext) -> Unreached:
    """Return floor that the tool could sweep by the map, but not coming from the station.

    Floor in a no-go zone does not count, but floor behind it does.
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
