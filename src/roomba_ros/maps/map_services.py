"""The services of the robot's own maps: finish, save, load, remove, list, update."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Final, NamedTuple

import rospy
from roomba_robot.srv import (
    ListMaps,
    ListMapsRequest,
    ListMapsResponse,
    NameMap,
    NameMapResponse,
)
from std_srvs.srv import Trigger, TriggerResponse

from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.perception.rooms.refit import refitted
from roomba.storage.map_store import MapStoreError, StoredMap
from roomba_ros.localization.topics import LocalizationTopics
from roomba_ros.maps.change_topics import ChangeTopics
from roomba_ros.maps.map_maker import MapMaker
from roomba_ros.maps.map_shelf import MapShelf
from roomba_ros.maps.map_wish import GIVEN, NONE, OWN
from roomba_ros.maps.own_map import NO_STATION, OwnMap

_BECOMES_WHOLE: Final = 5.0
"""s of wall time to wait for a map that is about to be finished."""
_LOOK: Final = 0.05
"""s of wall time between two looks whether the map is finished."""
_IS_GIVEN: Final = (
    "the robot was given its map: start it with map:=none (it makes a new one), map:=own (the one "
    "it made of this floor), or map:= and the name of a saved one"
)


class _Changed(NamedTuple):
    """A change that was accepted: the map's name, all of it ``before``, and the map ``after``."""

    name: str
    before: StoredMap
    after: OccupancyMap


class MapServices:
    """Answers the services of maps; a refused request gets the reason, and changes nothing."""

    def __init__(
        self,
        own: OwnMap,
        maker: MapMaker,
        shelf: MapShelf,
        changes: ChangeTopics,
        place: LocalizationTopics,
    ) -> None:
        """Connect nothing yet."""
        self._own, self._maker, self._place = own, maker, place
        self._shelf, self._changes = shelf, changes
        self._changed: _Changed | None = None

    def start(self, *, is_own: bool) -> None:
        """Connect."""
        self._is_own = is_own
        for name, work in (
            ("map/finish", self._finish),
            ("map/update/accept", self._accept),
            ("map/update/refuse", self._refuse),
            ("map/update/undo", self._undo),
        ):
            rospy.Service(name, Trigger, lambda _, work=work: self._answer(TriggerResponse, work))
        for name, deed in (
            ("map/save", self._save),
            ("map/load", self._load),
            ("map/remove", self._remove),
        ):
            rospy.Service(
                name,
                NameMap,
                lambda request, deed=deed: self._answer(
                    NameMapResponse, lambda: deed(request.name)
                ),
            )
        rospy.Service("map/list", ListMaps, self._on_list)

    def _finish(self) -> str:
        """Let the map be whole as it is."""
        with self._own.lock:
            if not self._maker.is_growing:
                raise MapStoreError("expected a map that is being made, got none")
            if self._maker.station is None and self._maker.has_dock:
                raise MapStoreError(NO_STATION)
            self._maker.finish()
        return "the map becomes whole"

    def _save(self, name: str) -> str:
        """Save the map by a name; an older map of that name hands on room names and zones."""
        if name in (GIVEN, NONE, OWN):
            raise MapStoreError(f"expected a name but {name!r}, which says how to begin (map:=…)")
        own = self._own
        before, stored = self._whole_map()
        is_made_anew = name != before and name in self._shelf.names
        saved = self._shelf.taken_over(name, stored) if is_made_anew else stored
        self._shelf.save(name, saved)
        if is_made_anew:
            try:
                self._shelf.go_by(saved)
            except (OSError, RoombaError) as error:
                return (
                    f"saved as {name} with the rooms and zones of the older map, but the robot "
                    f"does not go by them ({error}): mend that, and save it again"
                )
        with own.lock:
            # Another call may have loaded another map meanwhile.
            if own.occupancy is stored.occupancy:
                own.name = name
                own.remember()
                if is_made_anew:
                    own.tell_again()
        own.settle()
        return f"saved as {name} in {self._shelf.folder}"

    def _whole_map(self) -> tuple[str, StoredMap]:
        """Return the map's name and the map; wait a little for one that is about to be finished.

        The exploration's end is told first; then the map is finished, and then its rooms are found.
        """
        deadline = time.monotonic() + _BECOMES_WHOLE
        while True:
            try:
                with self._own.lock:
                    name, stored = self._own.name, self._own.stored()
                if stored.rooms is None:
                    raise MapStoreError("the rooms of this map are still being found; try again")
                return name, stored
            except MapStoreError:
                if time.monotonic() > deadline:
                    raise
            time.sleep(_LOOK)

    def _load(self, name: str) -> str:
        """Go on with a saved map; the robot finds its place on it, unless that is known."""
        own, stored = self._own, self._shelf.load(name)
        with own.lock:
            if self._maker.is_growing:
                raise MapStoreError("a map is being made: finish it first (map/finish)")
            at = None
            if self._maker.is_docked:
                at = stored.station
            elif own.occupancy is not None and own.occupancy.frame == stored.occupancy.frame:
                # It is another state of the same map.
                at = self._place.known_place
            own.use(name, stored, at)
        own.settle()
        return f"the robot goes by {name}"

    def _remove(self, name: str) -> str:
        self._shelf.remove(name)
        with self._own.lock:
            if self._own.name == name:
                self._own.name = ""
                self._own.remember()
        self._own.settle()
        return f"{name} is removed"

    def _accept(self) -> str:
        """Apply the offered change to the map and its rooms; a map that has a name is saved."""
        own = self._own
        with own.lock:
            name, before, proposed = own.name, own.stored(), self._changes.proposed()
        rooms = before.rooms and refitted(before.rooms, before.occupancy, proposed)
        stored = replace(before, occupancy=proposed, rooms=rooms)
        if name:
            self._shelf.save(name, stored)
        with own.lock:
            own.use_changed(name, stored)
        self._changed = _Changed(name, before, proposed)
        return "the map is changed"

    def _undo(self) -> str:
        """Go back to the map before the change that was accepted last."""
        own, changed = self._own, self._changed
        with own.lock:
            is_there = changed is not None and own.occupancy is changed.after
        if changed is None or not is_there:
            raise MapStoreError("expected an accepted change of this map to take back, got none")
        if changed.name:
            self._shelf.save(changed.name, changed.before)
        with own.lock:
            own.use_changed(changed.name, changed.before)
        self._changed = None
        return "the map is as it was"

    def _refuse(self) -> str:
        """Leave the map as it is, and do not ask again."""
        with self._own.lock:
            self._changes.refuse(rospy.get_time())
        return "the map stays as it is"

    def _answer(self, kind: type, work: Callable[[], str]) -> object:
        """Return a service's answer: what was done, or why not."""
        if not self._is_own:
            return kind(False, _IS_GIVEN)
        try:
            return kind(True, work())
        except RoombaError as error:
            return kind(False, str(error))
        except OSError as error:
            return kind(False, f"the disk refuses: {error}; nothing was changed")

    def _on_list(self, _: ListMapsRequest) -> ListMapsResponse:
        return ListMapsResponse(list(self._shelf.names), self._own.name)
