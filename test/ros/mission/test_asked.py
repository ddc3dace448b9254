"""Each kind of request is refused in its own way while there is no mission yet."""

import queue
from unittest.mock import MagicMock

from actionlib_msgs.msg import GoalStatus

from roomba.mission.phases.machine import Event
from roomba.vocabulary import RoomWay
from roomba_ros.mission.asked import (
    Cancel,
    CommandOrder,
    GoalOrder,
    GoalUnderWay,
    Order,
    RoomsOrder,
)
from roomba_ros.mission.goals import DockingGoal
from roomba_ros.runtime.action_goal import GoalIdentity

WHY = "the robot is not ready"


def test_of_a_goal_its_client_is_told_and_of_an_order_its_caller() -> None:
    handle = MagicMock()
    pause, rooms = CommandOrder(Event.PAUSE), RoomsOrder(("hall",), (RoomWay(2),))
    asked: list[Order] = [GoalOrder(DockingGoal(handle)), pause, rooms]
    asked.append(Cancel(GoalIdentity("dock", "1", 0, 0)))
    for each in asked:
        each.refuse(WHY)
    assert [call[0] for call in handle.method_calls] == ["set_rejected"]
    assert handle.set_rejected.call_args.args[1] == WHY
    assert (pause.answer.get_nowait(), rooms.answer.get_nowait()) == ((False, WHY),) * 2
    assert [each.waits for each in asked] == [True, False, False, False]


def test_a_goal_that_was_cancelled_before_does_not_begin() -> None:
    handle, mission, takes_drive = MagicMock(), MagicMock(), MagicMock()
    handle.get_goal_status.return_value = GoalStatus(status=GoalStatus.RECALLING)
    under_way = GoalUnderWay(takes_drive)
    GoalOrder(DockingGoal(handle)).obey(under_way, mission, MagicMock())
    assert handle.set_canceled.call_args.args[1] == "cancelled before it began"
    assert under_way.goal is None
    assert not mission.mock_calls
    assert not takes_drive.called


def test_the_answers_of_orders_are_of_their_own() -> None:
    first, second = CommandOrder(Event.PAUSE), CommandOrder(Event.PAUSE)
    assert isinstance(first.answer, queue.SimpleQueue)
    assert first.answer is not second.answer
