"""Setpoints and paths go out by their topics; no graph is needed for that."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from roomba_robot.msg import RobotPosition

from roomba.mission.walking.walk import Walk
from roomba.planning.path.planner import Path
from roomba_ros.walking.walk_topics import WalkTopics


def test_each_topic_is_told_what_is_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    told: dict[str, Any] = {}
    latched = []

    def publisher(topic: str, _: Any, *, latch: bool = False, **__: Any) -> SimpleNamespace:
        if latch:
            latched.append(topic)
        return SimpleNamespace(publish=lambda message: told.update({topic: message}))

    monkeypatch.setattr("rospy.Publisher", publisher)
    topics = WalkTopics()
    topics.start()
    topics.drive_to(1.0, 2.0)
    topics.drive_at(0.25)
    topics.turn_to(-1.5)
    walk = SimpleNamespace(path=Path(np.array([[0.0, 0.0], [1.0, 0.5]])))
    topics.show_path(3.0, cast(Walk, walk))
    plan = told.pop("plan")
    assert told == {
        "change_position": RobotPosition(1.0, 2.0),
        "change_speed": 0.25,
        "change_heading": -1.5,
    }
    assert (plan.header.frame_id, plan.header.stamp.to_sec()) == ("map", 3.0)
    end = plan.poses[-1].pose.position
    assert (end.x, end.y, latched) == (1.0, 0.5, ["plan"])
