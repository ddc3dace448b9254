"""Which of this machine's addresses a node listens at."""

from __future__ import annotations

import sys

import pytest
from fixtures.graph import RosGraph
from fixtures.processes.programs import listening
from fixtures.waiting import wait_until

from roomba.errors import RoombaError
from roomba_ros.runtime.graph.joining import is_loopback, require_own_address

NODE = """
from roomba_ros.runtime.graph.joining import join_graph
from std_msgs.msg import Empty
import rospy
import time
join_graph("joined")
rospy.Publisher("said", Empty, queue_size=1)
print("joined", flush=True)
time.sleep(600)
"""
NOT_CHOSEN = {"ROS_IP": None, "ROS_HOSTNAME": None}


@pytest.mark.parametrize(
    ("chosen", "address"),
    [({}, "127.0.0.1"), ({"ROS_HOSTNAME": "0.0.0.0"}, "0.0.0.0")],
    ids=["by default", "where it is told to"],
)
def test_a_node_listens_where_its_master_does_unless_an_address_is_chosen(
    graph: RosGraph, chosen: dict[str, str], address: str
) -> None:
    node = graph.run(sys.executable, "-c", NODE, environment={**NOT_CHOSEN, **chosen})
    wait_until(lambda: "joined" in node.output, 30.0, "it has joined")
    there = listening([node.process.pid])
    assert len(there) == 2
    assert {where for where, _ in there} == {address}


@pytest.mark.parametrize(
    ("uri", "is_it"),
    [
        ("http://localhost:11311", True),
        ("http://127.0.0.1:11311/", True),
        ("http://127.8.9.10:11311/", True),
        ("http://[::1]:11311/", True),
        ("http://robot:11311", False),
        ("http://192.168.0.2:11311", False),
        ("http://localhost.example:11311", False),
        ("", False),
    ],
)
def test_which_masters_are_reached_from_here_alone(uri: str, is_it: bool) -> None:
    assert is_loopback(uri) is is_it


HERE, ELSEWHERE = "http://localhost:11311", "http://192.0.2.1:11311"


@pytest.mark.parametrize(
    ("master", "chosen", "named"),
    [
        (HERE, {}, ""),
        (ELSEWHERE, {"ROS_IP": "127.0.0.1"}, ""),
        (HERE, {"ROS_HOSTNAME": "localhost"}, ""),
        (HERE, {"ROS_HOSTNAME": "0.0.0.0"}, ""),
        (HERE, {"ROS_IP": "192.0.2.5"}, "ROS_IP"),
        (HERE, {"ROS_IP": "127.0.0.1", "ROS_HOSTNAME": "nosuch.invalid"}, "ROS_HOSTNAME"),
    ],
)
def test_an_address_of_elsewhere_is_refused_with_the_name_of_its_variable(
    monkeypatch: pytest.MonkeyPatch, master: str, chosen: dict[str, str], named: str
) -> None:
    monkeypatch.setattr("roomba_ros.runtime.graph.joining.REACHED_WITHIN", 0.05)
    monkeypatch.setenv("ROS_MASTER_URI", master)
    for variable in ("ROS_IP", "ROS_HOSTNAME"):
        monkeypatch.delenv(variable, raising=False)
    for variable, value in chosen.items():
        monkeypatch.setenv(variable, value)
    if not named:
        require_own_address()
        return
    with pytest.raises(RoombaError, match=rf"^expected {named} to lead to this machine, got '"):
        require_own_address()
