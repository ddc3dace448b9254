"""A robot that cleans a home that it has never seen, without ROS: it makes its map meanwhile."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.grid import OccupancyMap
from roomba.headless.explorer import HeadlessExplorer
from roomba.headless.exploring_loop_kernels import TIME, TRUE
from roomba.headless.parts import require_end
from roomba.mission.cleaning.request import CleanRequest, CleanResult
from roomba.mission.mission import MissionStep
from roomba.perception.swept.dirt_map import DirtMap
from roomba.world.home.home import Home


@dataclass(frozen=True, slots=True, eq=False)
class NewcomerRecord:
    """What happened: ``poses`` has rows of t (s), x, y (m), theta (rad), true ones, map frame.

    ``occupancy`` is the map in the end; ``whole_at`` when it became whole, s.
    """

    result: CleanResult
    occupancy: OccupancyMap
    poses: NDArray[np.float64]
    hits: int
    whole_at: float


class HeadlessNewcomer(HeadlessExplorer):
    """One robot without a map in one home, on its station, that is told to clean."""

    def __init__(
        self,
        home: Home,
        robot: SimulatedRobotConfig | None = None,
        mission: MissionConfig | None = None,
        *,
        seed: int = 0,
    ) -> None:
        """Put the robot on its station and let it look around from there."""
        super().__init__(home, robot, mission, seed=seed, longest_burst=0)
        self._whole_at: float | None = None

    def clean(self, request: CleanRequest | None = None) -> NewcomerRecord:
        """Clean to the end; raises CleanRefusedError."""
        start, hits = self.seen.time, self.simulator.numbers["hits"]
        self.mission.clean(request or CleanRequest(), self.senses())
        while (result := self.mission.take_result()) is None:
            require_end(self.seen.time - start, self.simulator.home)
            self.tick()
        rows = np.concatenate(self.passed)
        return NewcomerRecord(
            result,
            self.mission.site.occupancy,
            np.column_stack((rows[:, TIME], rows[:, TRUE])),
            int(self.simulator.numbers["hits"] - hits),
            self.seen.time if self._whole_at is None else self._whole_at,
        )

    def tick(self) -> MissionStep:
        """Let one tick pass; when all was seen the map is finished."""
        step = super().tick()
        if step.wants_whole_map and self._whole_at is None:
            self._finish_map()
        return step

    def _finish_map(self) -> None:
        """Go on with the whole map."""
        occupancy = self.mapper.finish()
        self._whole_at, self._station = self.seen.time, self.mapper.start
        site = self._site(occupancy, is_growing=False)
        self.mission.use_map(site, self._look_beside(site), DirtMap(occupancy))

    def _show_map(self) -> None:
        """Let the mission go on with the map as it is now, until it is whole."""
        if self._whole_at is None:
            super()._show_map()
