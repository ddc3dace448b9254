"""The map that a live robot made, kept for the next time, with all that goes with it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final

from roomba.headless.embodied import Embodied
from roomba.headless.live.client import LiveClient
from roomba.headless.live.floor_plan import FloorPlan
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.storage.map_store import MapStore, MapStoreError, StoredMap

_ENDING: Final = 10.0
"""s of wall time for the last map to be written."""


class KeptHome:
    """A map by ``name`` in a store, with its rooms, zones, low things and carpets.

    ``tell`` is told in a sentence what the disk refuses. A thread of its own writes whenever the
    whole map, its rooms, zones or low things changed, and carpets when a clean is over.
    """

    def __init__(self, store: MapStore, name: str, tell: Callable[[str], object]) -> None:
        """Touch nothing yet."""
        self._store, self._name, self._tell = store, name, tell
        self._kept: tuple[object, ...] = ()
        self._carpets = FeltCarpets()
        self._changed = threading.Condition()
        self._waiting: StoredMap | None = None
        self._is_over = False
        self._thread = threading.Thread(target=self._write, name="kept map", daemon=True)

    def load(self) -> StoredMap | None:
        """Return the map that was kept, None if there is none; raises MapStoreError."""
        if self._name not in self._store.names():
            return None
        stored = self._store.load(self._name)
        self._kept = stored.occupancy, stored.rooms, stored.zones, stored.low_things
        self._carpets = stored.carpets
        return stored

    def start(self, client: LiveClient) -> None:
        """Keep the map of a robot from now on."""
        client.watch(lambda robot, _: self._look(robot, client.plan))
        self._thread.start()

    def stop(self) -> None:
        """Return once all changes are on the disk, or could not be written."""
        with self._changed:
            self._is_over = True
            self._changed.notify_all()
        if self._thread.ident is not None:
            self._thread.join(_ENDING)

    def _look(self, robot: Embodied, plan: FloorPlan) -> None:
        """Order a map to be written if it changed; called in the robot's thread."""
        context = robot.mission.context
        if context.is_growing:
            return
        low = robot.mission.obstacles.low
        now = context.occupancy, plan.rooms, plan.zones, low
        carpets = self._carpets if robot.mission.sweeps else robot.mission.carpets.felt
        is_same = len(self._kept) == len(now) and all(map(_is_same, self._kept, now))
        if is_same and carpets is self._carpets:
            return
        self._kept, self._carpets = now, carpets
        rooms = plan.rooms
        if rooms is not None and rooms.frame != context.occupancy.frame:
            rooms = None
        with self._changed:
            self._waiting = StoredMap(
                context.occupancy, context.station, rooms, plan.zones, low, carpets
            )
            self._changed.notify_all()

    def _write(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting is not None or self._is_over)
                stored, self._waiting = self._waiting, None
            if stored is None:
                return
            try:
                self._store.save(self._name, stored)
            except (MapStoreError, OSError) as error:
                self._tell(f"the map is not kept: {error}")


def _is_same(one: object, other: object) -> bool:
    return one is other
