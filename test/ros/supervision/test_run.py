"""Arguments and states that are refused before any process of the robot starts."""

from __future__ import annotations

from http.client import ResponseNotReady
from pathlib import Path

import pytest
from fixtures.graph import RosGraph, free_port

from roomba.storage.map_store import MapStoreError
from roomba_ros.maps.map_wish import require_map
from roomba_ros.supervision import run
from roomba_ros.supervision.claim import claim_robot
from roomba_ros.supervision.run import USAGE, main


def test_a_home_that_is_not_there_is_refused_before_anything_starts(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["home:=studoi"]) == USAGE
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("./roomba run: ")
    assert "expected the name of a home there or the path of a map_server yaml" in told.err
    assert "got 'studoi'" in told.err
    assert "studio" in told.err


@pytest.mark.parametrize(
    ("argument", "reason"),
    [
        ("bogus", "bogus"),
        ("map:=nosuch", "expected one of no maps, got 'nosuch'"),
    ],
)
def test_what_is_refused_is_refused_before_a_launch_is_told(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    argument: str,
    reason: str,
) -> None:
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    monkeypatch.setenv("ROOMBA_LAUNCHING", "Launching the robot.")
    assert main([argument]) == USAGE
    told = capsys.readouterr()
    assert "Launching" not in told.out + told.err
    assert reason in told.err


def test_an_address_that_is_not_of_this_machine_is_refused(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_HOSTNAME", "nosuch.invalid")
    assert main(["map:=given"]) == USAGE
    assert "expected ROS_HOSTNAME to lead to this machine" in capsys.readouterr().err


def test_a_run_that_begins_beside_another_one_is_refused(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    master = f"http://127.0.0.1:{free_port()}"
    monkeypatch.setenv("ROS_MASTER_URI", master)
    monkeypatch.setenv("ROS_NAMESPACE", "first")
    with claim_robot(master, "/first/"):
        assert main([]) == USAGE
    assert "got another run on this machine" in capsys.readouterr().err


@pytest.mark.parametrize("fault", [TimeoutError(), ResponseNotReady()])
def test_a_master_that_answers_no_more_ends_the_start(
    graph: RosGraph,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    fault: Exception,
) -> None:
    def hang(*_: object) -> None:
        raise fault

    for name, value in {**graph.environment, "ROS_LOG_DIR": str(tmp_path)}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(run, "set_parameters", hang)
    assert main(["map:=given"]) == 1
    assert "the master does not answer" in capsys.readouterr().err


def test_a_map_that_is_not_saved_is_refused_with_those_that_are(tmp_path: Path) -> None:
    for name in ("attic", "cellar"):
        (tmp_path / name).mkdir()
    for wish in ("given", "none", "own", "attic"):
        require_map(wish, tmp_path)
    with pytest.raises(MapStoreError, match=r"'attic', 'cellar', got 'celar'; did you mean"):
        require_map("celar", tmp_path)
