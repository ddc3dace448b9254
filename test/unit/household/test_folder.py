"""Where the household lives."""

from __future__ import annotations

from pathlib import Path

from roomba.household.folder import household_folder


def test_the_folder_is_the_named_one_or_lies_in_the_state_folder() -> None:
    assert household_folder({"ROOMBA_HOUSEHOLD": "/own", "ROS_HOME": "/ros"}) == Path("/own")
    assert household_folder({"ROOMBA_HOUSEHOLD": "own", "ROS_HOME": "/ros"}) == Path(
        "/ros/roomba_robot/household"
    )
