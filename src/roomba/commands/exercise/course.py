"""The exercises in order: where each has its texts, and which module checks what was written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

FOLDER: Final = Path(__file__).parents[4] / "exercises"
"""Of a checkout."""
_HERE: Final = "roomba.commands.exercise"
_ROS: Final = "roomba_ros.exercises"


@dataclass(frozen=True, slots=True)
class Exercise:
    """One task: its name is that of its folder, and of the learner's file; what it is about.

    ``check`` is the module that is run with the learner's file, for ``deadline`` s at most.
    """

    name: str
    about: str
    check: str
    deadline: float = 60.0

    @property
    def text(self) -> Path:
        """What is asked for."""
        return FOLDER / self.name / "README.md"

    @property
    def start(self) -> Path:
        """The file that a learner begins with."""
        return FOLDER / self.name / "start.py"


COURSE: Final = (
    Exercise("dirt_node", "ROS: a node that tells the dirt", f"{_ROS}.dirt_node"),
    Exercise("camera_service", "ROS: a service that gives pictures", f"{_ROS}.camera_service"),
    Exercise("walk_action", "ROS: an action that can be cancelled", f"{_ROS}.walk_action"),
    Exercise("shortest_path", "navigation: the shortest way on a map", f"{_HERE}.shortest_path"),
    Exercise("follow_path", "navigation: keep a robot on its path", f"{_HERE}.follow_path"),
    Exercise("cover_floor", "coverage: pass over all of a floor", f"{_HERE}.cover_floor"),
    Exercise("match_scan", "localization: where a scan was taken", f"{_HERE}.match_scan"),
)
