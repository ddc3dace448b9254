"""The action server gets cancels for goals that it does not know."""

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from fixtures.graph import RosGraph
from fixtures.nodes.errand import Errand
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from roomba_robot.msg import DockActionGoal, DockActionResult

from roomba_ros.runtime.action_goal import MOST_GOALS, GoalIdentity, server_of


def test_cancels_of_a_goal_to_come_are_no_errors_and_end_it(
    master: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    probe = Probe(master)
    errors: list[str] = []
    monkeypatch.setattr(rospy, "logerr", lambda text, *_: errors.append(text))
    taken: list[Errand] = []
    cancelled: list[GoalIdentity] = []
    server_of(Errand, taken.append, cancelled.append).start()
    ended: list[DockActionResult] = []
    rospy.Subscriber("/errand/result", DockActionResult, ended.append)
    for _ in range(3):
        probe.send("/errand/cancel", GoalID(id="late"))
    probe.send("/errand/cancel", GoalID(stamp=rospy.Time.now()))
    probe.send("/errand/goal", DockActionGoal(goal_id=GoalID(rospy.Time.now(), "other")))
    wait_until(lambda: taken, 20.0, "the other goal")
    probe.send("/errand/goal", DockActionGoal(goal_id=GoalID(rospy.Time.now(), "late")))
    wait_until(lambda: ended, 20.0, "the end of the goal that was cancelled before")
    (result,) = ended
    assert (result.status.goal_id.id, result.status.status) == ("late", GoalStatus.RECALLED)
    assert [goal.identity.identity for goal in taken] == ["other"]
    assert (cancelled, errors) == ([], [])


def test_of_a_flood_of_goals_and_cancels_the_first_are_taken(master: RosGraph) -> None:
    probe = Probe(master)
    taken: list[Errand] = []
    cancelled: list[GoalIdentity] = []
    server_of(Errand, taken.append, cancelled.append).start()
    longest: list[int] = []
    rospy.Subscriber(
        "/errand/status", GoalStatusArray, lambda told: longest.append(len(told.status_list))
    )
    rejected: list[str] = []
    rospy.Subscriber(
        "/errand/result",
        DockActionResult,
        lambda told: (
            rejected.append(told.status.goal_id.id)
            if told.status.status == GoalStatus.REJECTED
            else None
        ),
    )
    goals = probe.publisher("/errand/goal", DockActionGoal)
    cancels = probe.publisher("/errand/cancel", GoalID)
    wait_until(lambda: goals.get_num_connections() and cancels.get_num_connections(), 20.0)
    for number in range(2 * MOST_GOALS):
        goals.publish(DockActionGoal(goal_id=GoalID(rospy.Time.now(), f"goal {number}")))
        cancels.publish(GoalID(id=f"cancel {number}"))
    wait_until(lambda: longest and longest[-1] == MOST_GOALS, 20.0, lambda: f"{longest[-3:]}")
    # No client of what was not taken waits for ever.
    goals.publish(DockActionGoal(goal_id=GoalID(rospy.Time.now(), "one more")))
    wait_until(lambda: rejected and rejected[-1] == "one more", 20.0, lambda: f"{rejected[-3:]}")
    assert 0 < len(taken) <= MOST_GOALS
    assert max(longest) == MOST_GOALS
    # One that it knows can be cancelled all the same.
    probe.send("/errand/cancel", GoalID(id=taken[0].identity.identity))
    wait_until(lambda: cancelled, 20.0, "it is cancelled")
    assert [identity.identity for identity in cancelled] == [taken[0].identity.identity]
