"""Programs that outlive a restart of the robot join the graph of its new master."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.waiting import promised, wait_until

from roomba_ros.client.roomba_client import RoombaClient


@pytest.fixture
def own(tmp_path: Path) -> Iterator[RosGraph]:
    """A graph without a master."""
    with RosGraph(tmp_path) as made:
        yield made


def test_a_new_master_knows_what_was_there_before(own: RosGraph, tmp_path: Path) -> None:
    master = own.start_master()
    own.set_param("/most", 1.0)
    menu = own.rosrun("control_node.py")
    recorder = own.run(sys.executable, "-m", "roomba_ros.bags.record", str(tmp_path / "a.bag"))
    os.environ.update(own.environment)
    RoombaClient.connect("program")
    assert rospy.get_param_cached("/most") == 1.0

    def are_there() -> bool:
        publishers, subscribers, services = own.system_state()
        return (
            "/control_node" in publishers.get("/walk_to_point/goal", [])
            and {"/control_node", rospy.get_name()} <= set(subscribers.get("/position", []))
            and any("record" in node for node in subscribers.get("/rosout", []))
            and "/control_node/get_loggers" in services
        )

    wait_until(are_there, 30.0, lambda: f"all are there: {menu.output}{recorder.output}")
    master.clean_up()
    own.start_master()
    own.set_param("/most", 2.0)
    promised(
        lambda: are_there() and rospy.get_param_cached("/most") == 2.0,
        5.0,
        "all are there again, and hear the new value",
    )
    for program in (recorder, menu):  # which take a second to leave
        program.send(signal.SIGKILL)
