"""The mission's memory on disk: its errand, in case this node is killed, and the dirt map."""

from __future__ import annotations

import time
from pathlib import Path

import rospy

from roomba.configuration.nodes import MemoryConfig
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.perception.swept.dirt_map import DirtMap
from roomba.storage.checkpoint import (
    Checkpoint,
    CheckpointFileError,
    Goal,
    load_checkpoint,
    load_dirt,
    remove_checkpoint,
    save_checkpoint,
    save_dirt,
)
from roomba.storage.map_bound import map_file_name
from roomba.vocabulary import Phase
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.parameters import robot_run


class MissionMemory:
    """Keeps a robot's errand and dirt map for one map.

    The files in its ``folder`` are named by the map's digest.
    """

    def __init__(
        self, folder: Path, digest: str, config: MemoryConfig, background: Background
    ) -> None:
        """Read and write nothing yet."""
        self._checkpoint = folder / f"{map_file_name(digest)}.json"
        self._dirt = folder / f"{map_file_name(digest)}.npz"
        self._config, self._background = config, background
        self._run = robot_run()
        self._saved = 0.0
        self._last: tuple[Phase, Goal | None] | None = None
        self._taken_up = 0
        self._since = time.monotonic()
        self._is_there = True

    def recall_dirt(self, dirt: DirtMap) -> None:
        """Let a dirt map know what was learned before."""
        try:
            learned = load_dirt(self._dirt, dirt.frame.shape, rospy.logwarn)
        except CheckpointFileError as error:
            rospy.logwarn("where it is dirty is learned anew: %s", error)
            return
        if learned is not None:
            dirt.learned[:] = learned

    def recall_errand(self, mission: Mission, senses: Senses) -> Checkpoint | None:
        """Resume the errand of a killed mission; return its checkpoint, None without one."""
        try:
            found = load_checkpoint(self._checkpoint, self._run, rospy.logwarn)
            if found is None:
                return None
            if found.taken_up >= self._config.most_taken_up:
                raise CheckpointError(f"with it this node ended {found.taken_up} times in a row")
            self._taken_up = found.taken_up + 1
            found = found._replace(taken_up=self._taken_up)
            save_checkpoint(found, self._run, self._checkpoint)
            mission.restore(found.values, senses)
        except (CheckpointFileError, CheckpointError, OSError) as error:
            rospy.logwarn("the errand of before is not taken up: %s", error)
            return None
        rospy.logwarn("this node ended on an errand; it is taken up: %s", mission.state.phase.value)
        return found

    def keep(self, mission: Mission, senses: Senses, goal: Goal | None) -> None:
        """Save the errand and its client's goal, if due; forget them when there is none.

        A change is saved at once.
        """
        now, wall = (mission.state.phase, goal), time.monotonic()
        if now == self._last and wall - self._saved < self._config.errand:
            return
        self._last, self._saved = now, wall
        taken_up = self._taken_up if wall - self._since < self._config.goes_well else 0
        values = mission.checkpoint(senses)
        if values is not None:
            self._is_there = True
            self._background.do(
                f"the errand is not remembered in {self._checkpoint.name}",
                lambda: save_checkpoint(
                    Checkpoint(values, taken_up, goal), self._run, self._checkpoint
                ),
                subject=self._checkpoint.name,
            )
        elif self._is_there:
            self._is_there = False
            self.forget_errand()

    def forget_errand(self) -> None:
        """Forget the errand: it is over, or the robot was given another map."""
        self._background.do(
            f"the errand is not forgotten in {self._checkpoint.name}",
            lambda: remove_checkpoint(self._checkpoint),
            subject=self._checkpoint.name,
        )

    def keep_dirt(self, dirt: DirtMap) -> None:
        """Remember where it was dirty."""
        learned = dirt.learned.copy()
        self._background.do("dirt is not remembered", lambda: save_dirt(learned, self._dirt))
