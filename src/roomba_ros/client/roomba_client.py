"""The robot for programs: a whole clean in five lines, see examples/clean_home.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import rospy

from roomba.client.protocol import (
    CleanProgress,
    CleanReport,
    DockReport,
    ExploreReport,
    RobotClient,
    VacuumSnapshot,
    WalkReport,
)
from roomba.vocabulary import CleanMode, FanLevel
from roomba_ros.client.ros_client import RosRobot
from roomba_ros.runtime.graph.joining import join_graph
from roomba_ros.runtime.graph.master import master_state, require_answering
from roomba_ros.runtime.graph.staying import stay_in_graph
from roomba_ros.runtime.node import wait_for_clock

_LOOK = 1.0
"""s of wall time without news after which the client looks whether the errand has ended."""

_News = TypeVar("_News", covariant=True)
_Report = TypeVar("_Report", covariant=True)


class RoombaClient:
    """Tells the robot what to do and waits for it; reports say how it went.

    A request raises RobotUnavailableError, within seconds, if the robot does not answer, and
    RequestRefusedError if it makes no sense on any map, such as seven passes. Ctrl-C ends a walk.
    It also ends the waiting for a clean, but the robot goes on cleaning.
    """

    def __init__(self, robot: RobotClient) -> None:
        """Speak to a robot; ``robot`` itself offers more, such as ``pause()`` or ``rooms()``."""
        self.robot = robot

    @classmethod
    def connect(cls, node_name: str = "roomba_client") -> RoombaClient:
        """Become a ROS node, unless the program is one, and connect to the robot.

        Raises RobotUnavailableError without a ROS master, RoombaError for wrong parameters.
        """
        require_answering(master_state())
        if not rospy.core.is_initialized():
            join_graph(node_name, is_anonymous=True)
            stay_in_graph()
        wait_for_clock()
        robot = RosRobot()
        robot.start()
        return cls(robot)

    @property
    def state(self) -> VacuumSnapshot:
        """What the robot does now, its battery, and how far a clean is."""
        return self.robot.vacuum()

    def clean(
        self,
        on_progress: Callable[[CleanProgress], object] | None = None,
        *,
        mode: CleanMode = CleanMode.WHOLE,
        passes: int = 1,
        fan: FanLevel = FanLevel.STANDARD,
    ) -> CleanReport:
        """Clean the home, or what ``mode`` says, and go back to the station."""
        return _wait(self.robot.clean(mode, passes=passes, fan=fan), on_progress)

    def clean_rooms(
        self,
        *names: str,
        on_progress: Callable[[CleanProgress], object] | None = None,
        in_order: bool = False,
    ) -> CleanReport:
        """Clean rooms, the shortest way unless ``in_order``, and go back to the station."""
        return _wait(self.robot.clean(CleanMode.ROOMS, rooms=names, in_order=in_order), on_progress)

    def go_to(self, x: float, y: float) -> WalkReport:
        """Walk to a point, m, map frame."""
        walk = self.robot.walk_to(x, y)
        try:
            return _wait(walk)
        except BaseException:
            # an error or Ctrl-C ends the waiting: the robot must not walk on unseen
            walk.cancel()
            raise

    def explore(self, on_progress: Callable[[float], object] | None = None) -> ExploreReport:
        """Look at what the robot's own map does not show yet, and go back to the station.

        ``on_progress`` is told how much floor is known, m2.
        """
        return _wait(self.robot.explore(), on_progress)

    def dock(self) -> DockReport:
        """Go to the charging station, by its beams."""
        return _wait(self.robot.dock())

    def undock(self) -> DockReport:
        """Back out of the charging station."""
        return _wait(self.robot.undock())


class _Awaited(Protocol[_News, _Report]):
    """What a program waits for: a walk, a clean or a way to the station."""

    def next_feedback(self, timeout: float) -> _News | None: ...

    def report(self) -> _Report | None: ...


def _wait(
    errand: _Awaited[_News, _Report], on_news: Callable[[_News], object] | None = None
) -> _Report:
    """Return the end of an errand, which comes: a server that falls silent ends it."""
    while (report := errand.report()) is None:
        news = errand.next_feedback(_LOOK)
        if news is not None and on_news is not None:
            on_news(news)
    return report
