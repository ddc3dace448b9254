"""A made-up robot at the end of a serial line: started, commanded, and released."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.processes.programs import Program
from fixtures.robots.faulty_end import FaultyEnd
from fixtures.robots.neato_rig import NeatoEnd, neato_world
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.protocol import RequestRefusedError
from roomba.client.view import LayerName
from roomba.commands.play.command import main
from roomba.commands.play.owned import NOT_DOCKED, OwnedLife
from roomba.commands.trials.homes import rooms_of
from roomba.drivers.robots.table import ROBOTS
from roomba.geometry import Pose
from roomba.headless.live.client import LiveClient
from roomba.storage.map_store import MapStore, StoredMap

DEADLINE = 20.0
"""s of wall time."""


@pytest.fixture(autouse=True)
def own_maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROOMBA_MAPS", str(tmp_path / "maps"))


@pytest.fixture
def neato(tmp_path: Path) -> Iterator[NeatoEnd]:
    made = NeatoEnd(FaultyEnd(tmp_path / "neato"), neato_world())
    yield made
    made.close()


@pytest.fixture
def client(neato: NeatoEnd, tmp_path: Path) -> Iterator[LiveClient]:
    told: list[str] = []
    life = OwnedLife(ROBOTS["neato"], str(tmp_path / "neato"), makes_map=False, tell=told.append)
    life.client.start()
    yield life.client
    life.end()
    assert not told
    assert not neato.robot.is_testing
    assert not neato.robot.is_turning
    assert not neato.moves


def covered(client: LiveClient) -> float:
    return client.robot().vacuum.covered


def test_it_drives_maps_cleans_and_stands(neato: NeatoEnd, client: LiveClient) -> None:
    assert client.robot().vacuum.phase == "docked"
    station = neato.simulator.home.station
    client.clean(CleanRequest())
    wait_until(lambda: covered(client) > 0.3, 60.0, "some clean floor")
    wait_until(lambda: "Brush_RPM,1200" in neato.robot.answer("GetMotors"), 10.0, "it brushes")
    now = client.robot()
    map_ = client.layer(LayerName.MAP)
    assert map_ is not None
    assert (map_.cells == 1).sum() * map_.resolution**2 > 4.0
    assert len(now.scan) > 100
    # The frame of its map begins at its station.
    true = station.inverse().compose(neato.simulator.pose)
    assert math.dist(now.pose[:2], (true.x, true.y)) < 0.1
    client.pause()
    wait_until(lambda: not neato.moves, DEADLINE, "it stands")


def test_nothing_of_a_simulated_home_is_offered(client: LiveClient) -> None:
    assert client.limits().play == ()
    assert client.limits().camera_angles == ()
    assert client.layer(LayerName.TRUE_DIRT) is None
    assert client.robot().truth is None
    assert client.limits().max_speed == pytest.approx(0.3)


def test_a_line_that_is_gone_is_told_and_what_helps(neato: NeatoEnd, client: LiveClient) -> None:
    assert isinstance(neato.end, FaultyEnd)
    neato.end.unplug()
    wait_until(lambda: client.robot().vacuum.message, DEADLINE, "it is told")
    assert "cannot be reached" in client.robot().vacuum.message
    assert client.robot().held == ""
    neato.end.plug()
    wait_until(lambda: not client.robot().vacuum.message, DEADLINE, "it goes on by itself")


def test_it_beeps(neato: NeatoEnd, client: LiveClient) -> None:
    client.locate()
    wait_until(lambda: neato.robot.sound == 3, DEADLINE, "a beep")


def test_off_its_station_it_says_what_follows(neato: NeatoEnd, tmp_path: Path) -> None:
    neato.simulator.put(neato.simulator.home.station.compose(Pose(-1.0, 0.0, math.pi)))
    told: list[str] = []
    life = OwnedLife(ROBOTS["neato"], str(tmp_path / "neato"), makes_map=False, tell=told.append)
    life.end()
    assert told == [NOT_DOCKED]


def test_it_goes_by_the_map_that_it_kept(neato: NeatoEnd, tmp_path: Path) -> None:
    home, kind = neato.simulator.home, ROBOTS["neato"]
    MapStore(tmp_path / "maps").save(kind.name, StoredMap(home.map, home.station, rooms_of(home)))
    line = str(tmp_path / "neato")
    life = OwnedLife(kind, line, makes_map=False, tell=print)
    life.client.start()
    try:
        assert life.client.home().rooms
        true = neato.simulator.pose
        assert life.client.robot().pose == pytest.approx((true.x, true.y, true.theta), abs=0.05)
        with pytest.raises(RequestRefusedError, match="--map none"):
            life.client.explore()
    finally:
        life.end()
    other = OwnedLife(kind, line, makes_map=True, tell=print)
    assert other.client.plan.rooms is None
    other.end()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_command_gives_it_back_however_it_is_ended(
    neato: NeatoEnd, tmp_path: Path, number: signal.Signals
) -> None:
    arguments = ("--robot", "neato", "--line", str(tmp_path / "neato"))
    command = (
        sys.executable,
        "-m",
        "roomba.commands.program",
        "play",
        *arguments,
        "--port",
        "0",
        "--no-open",
    )
    program = Program(command, os.environ, tmp_path / "log")
    wait_until(lambda: "Ctrl-C ends it" in program.output, 60.0, lambda: program.output)
    assert neato.robot.is_testing
    program.send(number)
    assert program.ends(30.0) == 0
    assert not neato.robot.is_testing
    assert not neato.robot.is_turning
    assert "Traceback" not in program.output


def test_a_wrong_line_is_told_with_what_helps(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--robot", "neato", "--line", str(tmp_path / "ttyNone")]) == 2
    assert "Is it plugged in and switched on" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--robot", "neato"], "expected --robot NAME and --line DEVICE together"),
        (["--line", "/dev/null"], "expected --robot NAME and --line DEVICE together"),
        (["--robot", "neato", "--line", "x", "--speed", "2"], "--speed: of a simulated robot"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    given: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(given)
    assert left.value.code == 2
    assert said in capsys.readouterr().err


def test_threads_end_with_it(neato: NeatoEnd, tmp_path: Path) -> None:
    before = set(threading.enumerate())
    life = OwnedLife(ROBOTS["neato"], str(tmp_path / "neato"), makes_map=False, tell=print)
    life.client.start()
    life.end()
    assert set(threading.enumerate()) <= before
