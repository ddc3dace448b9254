"""A node with one of each thing that a program may use; it notes what the program sent."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import actionlib
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from roomba_robot.msg import (
    WalkToPointAction,
    WalkToPointFeedback,
    WalkToPointGoal,
    WalkToPointResult,
)
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse

BATTERY = BatteryState(voltage=14.4, temperature=math.nan, cell_voltage=[3.6, math.inf])


class Counterpart(Probe):
    """Publishes ``/battery`` (latched), hears ``/answer``, serves ``/ask`` and ``/walk``."""

    def __init__(self, graph: RosGraph) -> None:
        """Be that node."""
        super().__init__(graph, "counterpart")
        self.asked: list[bool] = []
        self.goals: list[WalkToPointGoal] = []
        self.hear("/answer", String)
        self._battery = rospy.Publisher("/battery", BatteryState, latch=True, queue_size=1)
        self._battery.publish(BATTERY)
        self._service = rospy.Service("/ask", SetBool, self._answer)
        self._walks = actionlib.SimpleActionServer("/walk", WalkToPointAction, self._walk, False)
        self._walks.start()
        rospy.set_param("/beside", {"depth": 3})

    def _answer(self, request: SetBoolRequest) -> SetBoolResponse:
        self.asked.append(request.data)
        return SetBoolResponse(True, "as you like")

    def _walk(self, goal: WalkToPointGoal) -> None:
        self.goals.append(goal)
        told = self._walks.action_server
        # The program has subscribed; its connections may come after its goal.
        for publisher in (told.feedback_pub, told.result_pub):
            wait_until(partial(_is_heard, publisher), 20.0, publisher.name)
        self._walks.publish_feedback(WalkToPointFeedback(distance=1.5))
        self._walks.set_succeeded(WalkToPointResult(time_spent=2.5))

    def require_used(self) -> None:
        """Fail unless a program published, asked and sent a goal, as all do that are run here."""
        assert self.newest["/answer"].data == "hello"
        assert self.asked == [True]
        assert [goal.destin.dest_x for goal in self.goals] == [1.25]
        assert rospy.get_param("/beside") == {"depth": 3, "told": [1, "two"]}


def _is_heard(publisher: rospy.Publisher) -> bool:
    return bool(publisher.get_num_connections() > 0)


def require_whole(told: dict[str, Any]) -> None:
    """Fail unless a program found all that there is and got all answers."""
    assert told["type"] == "sensor_msgs/BatteryState"
    assert "/battery" in told["topics"]
    assert "/ask" in told["services"]
    assert told["service_type"] == "std_srvs/SetBool"
    assert told["battery"]["voltage"] == 14.399999618530273
    assert told["battery"]["temperature"] is None
    assert told["battery"]["cell_voltage"] == [3.5999999046325684, None]
    assert told["asked"] == {"success": True, "message": "as you like"}
    assert told["refused"] == "there is no service /nowhere"
    assert told["parameter"] == 3
    assert told["feedback"] == 1.5
    assert told["result"] == {"time_spent": 2.5}
