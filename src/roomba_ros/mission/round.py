"""One round of a mission on ROS: in which order it obeys, tells, answers and acts."""

from __future__ import annotations

from collections.abc import Callable

import rospy

from roomba.geometry import Twist
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.mission.ticks import MissionStep
from roomba.robot.mapped_mission import fan_of
from roomba_ros.mission.drive import MissionDrive
from roomba_ros.mission.goals import Ended
from roomba_ros.mission.orders import MissionOrders
from roomba_ros.mission.topics import MissionTopics


class MissionRound:
    """One tick of a mission: its orders before it, and its messages after it."""

    def __init__(
        self,
        orders: MissionOrders,
        topics: MissionTopics,
        drive: MissionDrive,
        step: Callable[[Mission, Senses], MissionStep],
    ) -> None:
        """Take the parts, which the node starts; ``step`` lets a mission go on for one tick."""
        self._orders, self._topics, self._drive, self._step = orders, topics, drive, step

    def tick(
        self, now: float, mission: Mission, senses: Senses, *, begins: bool = True
    ) -> tuple[MissionStep, Ended]:
        """Obey, answer, act and tell; return what the mission wants, and what ended.

        New errands wait unless it ``begins`` them.
        """
        self._orders.obey(mission, senses, begins=begins)
        self._give_way(mission, senses)
        # Before the answers, whose callers find the new state; and before the step, which may plan
        # long.
        self._tell(now, mission, senses)
        self._orders.answer()
        step = self._step(mission, senses)
        self._act(mission, step)
        self._tell(now, mission, senses)
        return step, self._orders.follow(mission, senses)

    def _give_way(self, mission: Mission, senses: Senses) -> None:
        """Pause while another program drives."""
        reason = self._drive.taken_by
        if reason and mission.state.drives:
            mission.command(Event.PAUSE, senses)
            mission.message = reason
            rospy.logwarn("the mission is paused: %s", reason)

    def _act(self, mission: Mission, step: MissionStep) -> None:
        is_driving = mission.state.drives or step.twist != Twist()
        self._drive.drive(step.twist if is_driving else None, looks_around=step.looks_around)
        self._drive.set_fan(fan_of(mission))
        self._drive.empty(is_wanted=step.empties)

    def _tell(self, now: float, mission: Mission, senses: Senses) -> None:
        """Publish the state if it is due, and the progress to the client of the errand."""
        state = self._topics.tell(now, mission, senses)
        if state is not None:
            self._orders.tell(state)
