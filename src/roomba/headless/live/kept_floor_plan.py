"""The rooms and zones of a known map as a person edited them, kept for the next time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

from roomba.errors import RoomsError
from roomba.grid import OccupancyMap
from roomba.headless.live.floor_plan import FloorPlan
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.rooms import load_rooms, save_rooms
from roomba.storage.zones import load_zones, save_zones

FOLDER: Final = "floor_plans"
"""The name of the folder of these files."""


class KeptFloorPlan:
    """The floor plan of one map, in a folder of its own in ``folder``."""

    def __init__(
        self, folder: Path, occupancy: OccupancyMap, tell: Callable[[str], object]
    ) -> None:
        """Touch nothing yet; ``tell`` is told in a sentence what could not be read."""
        self._occupancy, self._tell = occupancy, tell
        own = folder / map_file_name(map_digest(occupancy))
        self._rooms_path, self._zones_path = own / "rooms.yaml", own / "zones.yaml"

    def load(self, plan: FloorPlan) -> FloorPlan:
        """Return a plan with the rooms and zones that were kept, where some were.

        Rooms that cannot be read are those of ``plan``, of which it is told. Raises ZonesError for
        zones that cannot be read: without them a robot may go where it must not.
        """
        zones = load_zones(self._zones_path, self._occupancy, self._tell)
        try:
            rooms = load_rooms(self._rooms_path, self._occupancy, self._tell)
        except RoomsError as error:
            self._tell(f"the rooms are as without edits: {error}")
            rooms = None
        return replace(
            plan,
            rooms=plan.rooms if rooms is None else rooms,
            zones=zones if self._zones_path.exists() else plan.zones,
        )

    def save(self, before: FloorPlan, plan: FloorPlan) -> None:
        """Keep what a plan has other than the one before; raises RoomsError, OSError."""
        if plan.rooms is not None and plan.rooms is not before.rooms:
            save_rooms(plan.rooms, self._occupancy, self._rooms_path)
        if plan.zones is not before.zones:
            save_zones(plan.zones, self._occupancy, self._zones_path)
