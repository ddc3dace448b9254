"""What the robot felt on each of its maps: one file for each map, read and written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Generic, TypeVar

import rospy

from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThings
from roomba.storage.carpets import load_carpets, save_carpets
from roomba.storage.low_things import load_low_things, save_low_things
from roomba.storage.map_bound import Tell, map_file_name
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background

Felt = TypeVar("Felt")


@dataclass(frozen=True, slots=True)
class FeltKind(Generic[Felt]):
    """What was felt, such as carpets: in words, with its files' ending, reader and writer."""

    words: str
    ending: str
    nothing: Felt
    load: Callable[[Path, OccupancyMap, Tell], Felt]
    save: Callable[[Felt, OccupancyMap, Path], None]


CARPETS: Final = FeltKind(
    "the carpets that were felt", "carpets.yaml", FeltCarpets(), load_carpets, save_carpets
)
LOW_THINGS: Final = FeltKind(
    "the low things that were felt",
    "low_things.yaml",
    LowThings(),
    load_low_things,
    save_low_things,
)


class FeltOnMaps(Generic[Felt]):
    """Remembers one kind for each finished map; nothing is saved for a map that is being made."""

    def __init__(self, kind: FeltKind[Felt], background: Background, folder: Path) -> None:
        """Touch nothing yet; files are kept in ``folder``, by the maps' digests."""
        self._kind, self._background, self._folder = kind, background, folder

    def recalled(self, home: KnownHome) -> Felt:
        """Return what was felt before on a home's map; nothing where it cannot be read."""
        if home.digest == GROWING:
            return self._kind.nothing
        try:
            return self._kind.load(self._path(home), home.context.occupancy, rospy.logwarn)
        except RoombaError as error:
            rospy.logwarn("%s are felt anew: %s", self._kind.words, error)
            return self._kind.nothing

    def keep(self, home: KnownHome, felt: Felt) -> None:
        """Save what was felt on a home's map, soon."""
        if home.digest == GROWING:
            return
        save, occupancy, path = self._kind.save, home.context.occupancy, self._path(home)
        self._background.do(
            f"{self._kind.words} are not remembered", lambda: save(felt, occupancy, path)
        )

    def _path(self, home: KnownHome) -> Path:
        return self._folder / f"{map_file_name(home.digest)}.{self._kind.ending}"
