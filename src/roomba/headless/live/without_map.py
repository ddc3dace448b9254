"""Requests that need a map: the client of a robot without one refuses them, with the reason."""

from __future__ import annotations

from typing import ClassVar

from roomba.client import view
from roomba.client.protocol import RequestRefusedError
from roomba.geometry import Point
from roomba.vocabulary import RoomWay


class WithoutMap:
    """Refuses requests for rooms, zones and explorations; ``no_map`` is the reason."""

    no_map: ClassVar[str]
    """Why there is no map, in words."""

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Refuse it: there are no rooms."""
        raise RequestRefusedError(self.no_map)

    def explore(self) -> None:
        """Refuse it: the robot tells no map."""
        raise RequestRefusedError(self.no_map)

    def put_zone(self, zone: view.ZoneView) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def remove_zone(self, name: str) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def rename_room(self, name: str, new_name: str) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def split_room(self, name: str, start: Point, end: Point) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def undo_rooms(self) -> None:
        """Refuse it."""
        raise RequestRefusedError(self.no_map)

    def empty_at_station(self) -> None:
        """Refuse it: the robot's station empties no bin."""
        raise RequestRefusedError("its station empties no bin: empty it by hand")

    def replace_bag(self) -> None:
        """Refuse it: the robot's station has no bag."""
        raise RequestRefusedError("its station has no bag")
