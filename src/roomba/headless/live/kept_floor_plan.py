"""The rooms and zones of a known map as a person edited them, kept for the next time."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

from roomba.configuration.mapping import FloorsConfig
from roomba.errors import HomeError, RoomsError
from roomba.files.home_layer import LAYER_NAME
from roomba.geometry import Pose
from roomba.headless.live.floor_plan import FloorPlan
from roomba.perception.floors.carry_over import carry_over, divided_as, moved
from roomba.perception.floors.recognition import FloorRecord
from roomba.perception.floors.same_floor import match_floors
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.map_folder import (
    ROOMS_NAME,
    ZONES_NAME,
    StoredMap,
    read_floor,
    write_floor,
)
from roomba.storage.rooms import load_rooms, save_rooms
from roomba.storage.zones import load_zones, save_zones
from roomba.vocabulary import another_name

FOLDER: Final = "floor_plans"
"""The name of the folder of these files."""


class KeptFloorPlan:
    """The floor plan of one map: a folder in ``folder`` that holds plan and map.

    If a map has no plan yet and shows the same floor as another map here, it takes over the plan of
    that map: rooms and zones outlive a change of the home.
    """

    def __init__(
        self,
        folder: Path,
        floor: FloorRecord,
        config: FloorsConfig,
        tell: Callable[[str], object],
    ) -> None:
        """Touch nothing yet; ``tell`` is told in a sentence what could not be read or kept."""
        self._floor, self._config, self._tell = floor, config, tell
        self._folder = folder
        self._own = folder / map_file_name(map_digest(floor.occupancy))

    def load(self, plan: FloorPlan) -> FloorPlan:
        """Return ``plan`` with the rooms and zones that were kept, if there are any.

        If kept rooms cannot be read, ``plan`` keeps its own, and ``tell`` is told. Raises
        ZonesError for zones that cannot be read: without them a robot may go where it must not.
        """
        if _has_plan(self._own):
            return self._own_plan(plan)
        others = [each for each in self._folder.glob("[!.]*") if _has_plan(each)]
        for folder in sorted(others, key=_edited, reverse=True):
            floor = _floor_in(folder)
            match = None if floor is None else match_floors(self._floor, floor, self._config)
            if floor is not None and match is not None and match.is_same:
                return self._taken_over(plan, *self._read(folder, floor), match.old_in_new)
        return plan

    def save(self, before: FloorPlan, plan: FloorPlan) -> None:
        """Keep what ``plan`` has other than ``before``; raises RoomsError, OSError."""
        self._write(self._own, before, plan)

    def _own_plan(self, plan: FloorPlan) -> FloorPlan:
        rooms, zones = self._read(self._own, self._floor)
        # Older programs kept no map beside the plan, and a damaged map is of no use.
        with self._telling_trouble():
            if _floor_in(self._own) is None:
                self._write_floor(self._own)
        return _with(plan, rooms, zones)

    def _read(self, folder: Path, floor: FloorRecord) -> tuple[Rooms | None, Zones | None]:
        """Return the rooms and zones that were kept of a floor, each None if none were."""
        zones = load_zones(folder / ZONES_NAME, map_digest(floor.occupancy), self._tell)
        try:
            rooms = load_rooms(folder / ROOMS_NAME, floor.occupancy, self._tell)
        except RoomsError as error:
            self._tell(f"the rooms are as without edits: {error}")
            rooms = None
        return rooms, zones if (folder / ZONES_NAME).exists() else None

    def _taken_over(
        self, plan: FloorPlan, rooms: Rooms | None, zones: Zones | None, old_in_new: Pose
    ) -> FloorPlan:
        """Return ``plan`` with rooms and zones of the map before its change, and keep it."""
        kept = plan.zones
        for zone in moved(zones or Zones(), old_in_new).all:
            # A zone of this name from the home's own files is a different zone.
            is_taken = zone.name in kept.names and zone not in kept.all
            name = another_name(zone.name, kept.names) if is_taken else zone.name
            kept = kept.with_zone(replace(zone, name=name))
        taken = _with(plan, self._divided(plan.rooms, rooms, old_in_new), kept)
        self._tell("the map changed since its rooms or zones were edited; they are taken over")
        with self._telling_trouble():
            # All of it or nothing: the next start would take half a plan for all of it.
            unfinished = self._own.with_name(f".{self._own.name}.new")
            shutil.rmtree(unfinished, ignore_errors=True)
            self._write(unfinished, FloorPlan(plan.rooms), taken)
            shutil.rmtree(self._own, ignore_errors=True)
            unfinished.rename(self._own)
        return taken

    def _divided(self, new: Rooms | None, old: Rooms | None, old_in_new: Pose) -> Rooms | None:
        """Return the map's rooms with the edits that people made before the map changed."""
        if new is None or old is None:
            return new
        as_before = divided_as(old, new) if old_in_new == Pose() else None
        if as_before is not None:
            return as_before
        return carry_over(new, old, Zones(), self._config.same_room, old_in_new).rooms

    def _write(self, folder: Path, before: FloorPlan, plan: FloorPlan) -> None:
        """Write the map, by which a later map finds this plan, and what differs from ``before``."""
        occupancy = self._floor.occupancy
        if not (folder / LAYER_NAME).exists():  # is written last of a map's files
            self._write_floor(folder)
        if plan.zones is not before.zones:
            save_zones(plan.zones, map_digest(occupancy), folder / ZONES_NAME)
        if plan.rooms is not None and plan.rooms is not before.rooms:
            save_rooms(plan.rooms, occupancy, folder / ROOMS_NAME)

    def _write_floor(self, folder: Path) -> None:
        write_floor(StoredMap(self._floor.occupancy, self._floor.station), folder)

    @contextlib.contextmanager
    def _telling_trouble(self) -> Iterator[None]:
        """Tell what the disk refuses, and go on."""
        try:
            yield
        except (OSError, RoomsError) as error:
            self._tell(f"the rooms and zones of this map are not kept: {error}")


def _with(plan: FloorPlan, rooms: Rooms | None, zones: Zones | None) -> FloorPlan:
    """Return a plan with these rooms and zones in place of its own; None keeps its own."""
    return replace(
        plan,
        rooms=plan.rooms if rooms is None else rooms,
        zones=plan.zones if zones is None else zones,
    )


def _has_plan(folder: Path) -> bool:
    """Whether rooms or zones, even damaged ones, were kept in a folder."""
    return any(any(folder.glob(f"{name}*")) for name in (ROOMS_NAME, ZONES_NAME))


def _floor_in(folder: Path) -> FloorRecord | None:
    """Return the map beside a plan; None where it is not there, or damaged."""
    try:
        return FloorRecord(*read_floor(folder))
    except (HomeError, OSError):
        return None


def _edited(folder: Path) -> float:
    """Return when rooms or zones were kept there last, s."""
    times = [0.0]
    for name in (ROOMS_NAME, ZONES_NAME):
        with contextlib.suppress(OSError):
            times.append((folder / name).stat().st_mtime)
    return max(times)
