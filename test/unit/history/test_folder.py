"""Where the history lives."""

from __future__ import annotations

from pathlib import Path

from roomba.history.folder import history_folder


def test_the_first_that_is_said_counts() -> None:
    assert history_folder({"ROOMBA_HISTORY": "/own", "ROS_HOME": "/ros"}) == Path("/own")
    given = {"ROS_HOME": "/ros", "XDG_STATE_HOME": "/state"}
    assert history_folder(given) == Path("/ros/roomba_robot/history")
    state = {"XDG_STATE_HOME": "/state"}
    assert history_folder(state) == Path("/state/roomba_robot/history")
    home = Path.home() / ".local/state/roomba_robot/history"
    assert history_folder({}) == home
    assert history_folder({"XDG_STATE_HOME": "relative"}) == home
