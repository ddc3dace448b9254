"""The robot's own unnamed map, saved on disk so that it survives a kill of this node."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path
from typing import Final

import rospy

from roomba.configuration.nodes import MemoryConfig
from roomba.geometry import Pose
from roomba.perception.slam.mapper_state import MapperState
from roomba.storage.map_store import MapStore, MapStoreError, StoredMap
from roomba.storage.mapper import (
    KeptMap,
    MapperFileError,
    load_mapper,
    remove_mapper,
    save_mapper,
)
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.parameters import robot_name, robot_run

FOLDER: Final = ".being_made"
"""A folder in that of the maps; no map can have this name."""
_BEING_MADE: Final = "being made"
_WHOLE: Final = "whole"
"""Subjects of the background's work, of which only the newest counts; the latter is a folder,
too."""


class MapMemory:
    """Saves a map that is being made, or a finished one without a name; each robot has a folder.

    A saved map counts only in the run of the robot in which it was made.
    """

    def __init__(self, config: MemoryConfig, background: Background) -> None:
        """Read nothing yet."""
        self._config, self._background = config, background
        self._kept = (-1, False)
        self._saved = self._saved_wall = -math.inf
        self._bytes = 0
        self._taken_up = self._times_kept = 0
        self._since = time.monotonic()

    def start(self, maps: Path) -> None:
        """Take the folder of all maps."""
        self._path = maps / FOLDER / robot_name() / "map.npz"
        self._run = robot_run()
        self._whole = MapStore(self._path.parent / _WHOLE, rospy.logwarn)

    @property
    def is_there(self) -> bool:
        """Whether a map that was being made was left behind, by any run."""
        return self._path.exists()

    def recall(self) -> KeptMap | None:
        """Return the unfinished map that a killed node of this run was making; None without one."""
        try:
            kept = load_mapper(self._path, rospy.logwarn)
            if kept is None or kept.run != self._run:
                return None
            if kept.taken_up >= self._config.most_taken_up:
                raise MapperFileError(f"with it this node ended {kept.taken_up} times in a row")
            self._taken_up = kept.taken_up + 1
            save_mapper(replace(kept, taken_up=self._taken_up), self._path)
        except (MapperFileError, OSError) as error:
            rospy.logwarn("the map that was being made is not taken up, a new one is: %s", error)
            return None
        return kept

    def is_due(self, now: float, version: int, *, is_lost: bool) -> bool:
        """Whether it is time to save a map of this version: a new one, a while after the last.

        It is also due once when the node has run well for a while with a map that it took up.
        """
        went_well = self._taken_up > 0 and time.monotonic() - self._since >= self._config.goes_well
        is_news = (version, is_lost) != self._kept or went_well
        if not is_news or 0.0 <= now - self._saved < self._config.map:
            return False
        return time.monotonic() - self._saved_wall >= self._config.map_wall_per_byte * self._bytes

    def keep(
        self,
        now: float,
        state: MapperState,
        station: Pose | None,
        station_from_start: Pose | None,
    ) -> None:
        """Remember a map, soon; for the station see :class:`KeptMap`."""
        wall = time.monotonic()
        self._saved, self._saved_wall = now, wall
        self._kept = state.version, state.is_lost
        if wall - self._since >= self._config.goes_well:
            self._taken_up = 0
        self._times_kept += 1
        kept = KeptMap(state, self._run, station, station_from_start, self._taken_up)
        self._background.do(
            "the map that is being made is not remembered",
            lambda: self._save(kept),
            subject=_BEING_MADE,
        )

    def forget(self) -> None:
        """Forget the map that was being made, soon: it is whole, or another one is begun."""
        self._kept = (-1, False)
        self._background.do(
            "the map that was being made is not forgotten",
            lambda: remove_mapper(self._path),
            subject=_BEING_MADE,
        )

    def recall_whole(self) -> StoredMap | None:
        """Return the finished map without a name that this run used; None without one."""
        try:
            return self._whole.load(self._run) if self._run in self._whole.names() else None
        except (MapStoreError, OSError) as error:
            rospy.logwarn("the map that was made is lost: %s", error)
            return None

    def keep_whole(self, stored: StoredMap) -> None:
        """Remember a whole map that has no name, soon, instead of the one that was being made."""
        times_kept = self._times_kept
        self._background.do(
            "the map that was made is not remembered",
            lambda: self._replace_by(stored, times_kept),
            subject=_WHOLE,
        )

    def _replace_by(self, stored: StoredMap, times_kept: int) -> None:
        """Save the finished map; if that fails, the one that was being made stays saved."""
        if self._run:
            self._whole.save(self._run, stored)
        if times_kept == self._times_kept:  # no other map is being made by now
            self.forget()

    def forget_whole(self) -> None:
        """Forget the whole map, soon: another one is begun, or it has a name by now."""
        self._background.do("the whole map is not forgotten", self._remove_whole, subject=_WHOLE)

    def _remove_whole(self) -> None:
        for run in self._whole.names():
            self._whole.remove(run)

    def _save(self, kept: KeptMap) -> None:
        save_mapper(kept, self._path)
        self._bytes = self._path.stat().st_size
