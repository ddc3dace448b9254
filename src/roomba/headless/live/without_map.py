"""What a robot without a map cannot be told: its client refuses that, with the reason."""

from __future__ import annotations

from typing import ClassVar

from roomba.client import view
from roomba.client.protocol import RequestRefusedError
from roomba.geometry import Point
from roomba.vocabulary import RoomWay


class WithoutMap:
    """Refuses, by ``no_map``, what rooms, zones and explorations are needed for."""

    no_map: ClassVar[str]
    """Why there is no map, in words."""

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Refuse it: there are no rooms."""
        raise RequestRefusedError(self.no_map)

    def explore(self) -> None:
        """Refuse it: it makes no map that is told."""
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
        """Refuse it: its station does not."""
        raise RequestRefusedError("its station empties no bin: empty it by hand")

    def replace_bag(self) -> None:
        """Refuse it: there is none."""
        raise RequestRefusedError("its station has no bag")
