"""Each program that asks a master that hangs reports it within a deadline."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fixtures.graph import free_port

from roomba.client.protocol import RobotUnavailableError
from roomba_ros.bags import record
from roomba_ros.camera import turn_camera_client
from roomba_ros.client import control_node
from roomba_ros.client.roomba_client import RoombaClient
from roomba_ros.dirt.dirt_pub_node import DirtPubNode
from roomba_ros.rosbridge.graph import topic_types
from roomba_ros.runtime.graph.master import MasterState, master_state
from roomba_ros.runtime.node import run_node
from roomba_ros.supervision import run
from roomba_ros.supervision.kept_master import wait_for_master
from roomba_ros.supervision.launch_parameters import set_parameters


@pytest.fixture
def hanging(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A master that was stopped: connections to it are taken, and nothing is answered."""
    monkeypatch.setattr("roomba_ros.runtime.graph.master.ANSWER_WITHIN", 0.05)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        uri = f"http://127.0.0.1:{silent.getsockname()[1]}"
        monkeypatch.setenv("ROS_MASTER_URI", uri)
        yield uri


def test_one_that_is_not_there_is_absent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{free_port()}")
    assert master_state() is MasterState.ABSENT


def test_one_that_hangs_is_told_of(hanging: str) -> None:
    assert master_state() is MasterState.HANGS
    with pytest.raises(RobotUnavailableError, match=f"expected the ROS master at {hanging} to"):
        RoombaClient.connect()
    assert not wait_for_master(0.1, lambda: False)


@pytest.mark.parametrize(
    ("program", "status"),
    [
        (lambda folder: run.main([]), run.USAGE),
        (lambda folder: record.main([str(folder / "a.bag")]), 1),
        (lambda folder: control_node.main(), 1),
        (lambda folder: turn_camera_client.main(), 1),
        (lambda folder: run_node("dirt_pub_node", DirtPubNode), 1),
    ],
    ids=["run", "record", "control", "camera", "a node"],
)
def test_each_program_says_that_it_hangs_and_ends(
    hanging: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    program: Callable[[Path], object],
    status: int,
) -> None:
    try:
        ended = program(tmp_path)
    except SystemExit as left:
        ended = left.code
    assert ended == status
    told = capsys.readouterr().err
    assert f"expected the ROS master at {hanging} to answer within" in told
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "asks", [topic_types, lambda: set_parameters({"/a": 1}, "a run")], ids=["bridge", "run"]
)
def test_what_asks_on_the_way_gives_up_in_time(hanging: str, asks: Callable[[], object]) -> None:
    with pytest.raises(TimeoutError):
        asks()
