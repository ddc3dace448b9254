"""Programs that go on while the robot is started anew are in the graph of its new master."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until

from roomba_ros.runtime.graph.staying import stay_in_graph


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
    Probe(own)
    stay_in_graph()
    assert rospy.get_param_cached("/most") == 1.0

    def are_there() -> bool:
        publishers, subscribers, services = own.system_state()
        return (
            "/control_node" in publishers.get("/walk_to_point/goal", [])
            and "/control_node" in subscribers.get("/position", [])
            and any("record" in node for node in subscribers.get("/rosout", []))
            and "/control_node/get_loggers" in services
        )

    wait_until(are_there, 30.0, lambda: f"both are there: {menu.output}{recorder.output}")
    master.clean_up()
    own.start_master()
    own.set_param("/most", 2.0)
    wait_until(are_there, 20.0, "both are there again")
    wait_until(lambda: rospy.get_param_cached("/most") == 2.0, 20.0, "the new value is heard")
    for program in (recorder, menu):  # which take a second to leave
        program.send(signal.SIGKILL)
