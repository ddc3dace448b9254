"""Changes of the home during a mission: other zones or rooms, or more of the map."""

from __future__ import annotations

from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.phases.job import Job
from roomba.mission.transitions import Transitions
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import Phase

_LOOKING = (Phase.EXPLORING, Phase.CLEANING)


class ChangedHome:
    """Lets a mission go on in the home as it is known now."""

    def __init__(
        self, transitions: Transitions, job: Job, drives: Drives, obstacles: Obstacles
    ) -> None:
        """Take the mission's parts."""
        self._transitions, self._job, self._drives = transitions, job, drives
        self._obstacles = obstacles

    def use_context(self, context: PlanningContext) -> None:
        """Go on with other zones or rooms, from the next tick on."""
        job = self._job
        self._drives.use_context(context)
        if not self._goes_on_looking():
            self._transitions.drop_driver()
        if job.cleaning is not None:
            was_done = job.cleaning.ledger.stage is None
            job.cleaning.use_context(context, job.dirt)
            job.look_no_more(context.known)
            if was_done and job.cleaning.ledger.stage is not None:
                self._transitions.clean_on()

    def use_map(
        self, context: PlanningContext, things: ThingLayer, dirt: DirtMap, moved: Pose
    ) -> None:
        """Go on with a map that has grown, or with the whole one, from the next tick on.

        ``things`` and ``dirt`` are new and belong to that map; the frame of the map before lies at
        ``moved`` in its frame.
        """
        job = self._job
        dirt.carry_on(job.dirt, moved)
        self._obstacles.use(things, moved)
        self._drives.trail.move(moved)
        if job.exploration is not None:
            job.exploration.move(moved)
        job.dirt = dirt
        job.bin.forget_places()
        self.use_context(context)

    def wants_map(self, occupancy: OccupancyMap) -> bool:
        """Whether the grown map ``occupancy`` makes a difference to what the robot does."""
        phase, exploration = self._transitions.state.phase, self._job.exploration
        if self._drives.driver is None:
            # Near its station the robot goes by beams, and taking up a new map would make it late.
            return phase not in (Phase.UNDOCKING, Phase.DOCKING)
        if phase is Phase.RETURNING:
            # Its way leads over known floor; a path planned anew each time begins with a turn.
            return False
        if exploration is None:
            return False
        return exploration.wants_another(occupancy) or self._is_walled(occupancy)

    def _is_walled(self, occupancy: OccupancyMap) -> bool:
        """Whether the robot is on its way to a frontier, and a map shows something new on that way.

        No look ahead can tell what stands close to a wall of the present map from that wall.
        """
        exploration, drives = self._job.exploration, self._drives
        if drives.driver is None or drives.is_round or exploration is None:
            return False
        return exploration.is_under_way and drives.context.has_new_on(
            drives.driver.tracker.rest, occupancy
        )

    def _goes_on_looking(self) -> bool:
        """Whether the robot is on its way to a frontier that still is one, and that way is free."""
        exploration, driver = self._job.exploration, self._drives.driver
        if self._transitions.state.phase not in _LOOKING or driver is None or exploration is None:
            return False
        context = self._drives.context
        if not exploration.is_under_way or exploration.wants_another(context.known):
            return False
        return context.paths.is_free(driver.tracker.rest)
