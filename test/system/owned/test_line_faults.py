"""A body on a line that is unplugged, silent, garbled, and whole again: in real time."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.robots.faulty_end import FaultyEnd
from fixtures.robots.neato_rig import NeatoEnd, neato_world
from fixtures.waiting import wait_until

from roomba.drivers.line_body import LineBody, NoScanError
from roomba.drivers.robots.table import ROBOTS
from roomba.geometry import Twist
from roomba.robot.command import Command

PROMISE = 0.5
"""s; so long after the last command that it heard the robot stands."""
AHEAD = Command(Twist(0.1, 0.0))


@pytest.fixture
def neato(tmp_path: Path) -> Iterator[NeatoEnd]:
    made = NeatoEnd(FaultyEnd(tmp_path / "neato"), neato_world())
    yield made
    made.close()


@pytest.fixture
def body(neato: NeatoEnd, tmp_path: Path) -> Iterator[LineBody]:
    kind = ROBOTS["neato"]
    body = kind.body_on(str(tmp_path / "neato"), kind.config())
    body.start()
    yield body
    body.stop()


def end_of(neato: NeatoEnd) -> FaultyEnd:
    assert isinstance(neato.end, FaultyEnd)
    return neato.end


def act_until(body: LineBody, is_so: Callable[[], bool], what: str, deadline: float = 10.0) -> None:
    def acted() -> bool:
        body.act(AHEAD)
        return is_so()

    wait_until(acted, deadline, what, pause=0.0)


def stands_in_time(neato: NeatoEnd, body: LineBody) -> None:
    """Assert that it stands in time and stays so, though its brain wants it to drive on."""
    silent = neato.simulator.time
    act_until(body, lambda: not neato.moves, "it stands")
    assert neato.simulator.time - silent <= PROMISE + 0.05 + 1e-9


def test_a_command_lasts_a_tick(body: LineBody) -> None:
    times, before = [time.monotonic()], body.read().time
    for _ in range(20):
        body.act(Command())
        times.append(time.monotonic())
    # On a busy machine one or the other ends late.
    assert np.median(np.diff(times)) == pytest.approx(0.05, abs=0.005)
    assert body.read().time - before == pytest.approx(times[-1] - times[0], abs=0.06)


def test_unplugged_it_stands_and_plugged_in_it_goes_on(neato: NeatoEnd, body: LineBody) -> None:
    begin = neato.simulator.pose
    act_until(body, lambda: body.read().odometry.x > 0.1, "it drives")
    end_of(neato).unplug()
    stands_in_time(neato, body)
    act_until(body, lambda: bool(body.trouble), "it is told")
    assert "Plug its line in" in body.trouble.text
    stood = body.read()
    act_until(body, lambda: neato.simulator.time > stood.time + 3.0, "time passes")
    assert body.read().time == stood.time
    end_of(neato).plug()
    act_until(body, lambda: body.read().odometry.x > stood.odometry.x + 0.1, "it goes on by itself")
    assert not body.trouble
    # What it rolled after it was told last counts as well.
    told, true = body.read().odometry, begin.inverse().compose(neato.simulator.pose)
    assert told.distance_to(true.x, true.y) < 0.015


def test_two_seconds_of_silence(neato: NeatoEnd, body: LineBody) -> None:
    act_until(body, lambda: neato.moves, "it drives")
    end_of(neato).be_silent(2.0)
    stands_in_time(neato, body)
    act_until(body, lambda: bool(body.trouble), "it is told")
    act_until(body, lambda: neato.moves and not body.trouble, "it goes on by itself")


def test_half_answers_and_ten_thousand_random_bytes(neato: NeatoEnd, body: LineBody) -> None:
    random = np.random.default_rng(1)
    act_until(body, lambda: neato.moves, "it drives")
    for _ in range(20):
        end_of(neato).say(random.bytes(500))
        body.act(AHEAD)
    end_of(neato).halve(6)
    began = body.read()
    act_until(body, lambda: not body.trouble and body.read().time > began.time + 2.0, "it goes on")
    act_until(body, lambda: neato.moves and not body.trouble, "it drives on")
    moved = body.read().odometry
    assert moved.distance_to(began.odometry.x, began.odometry.y) > 0.1


def test_the_robot_is_given_back(neato: NeatoEnd, tmp_path: Path) -> None:
    kind = ROBOTS["neato"]
    body = kind.body_on(str(tmp_path / "neato"), kind.config())
    body.start()
    assert neato.robot.is_testing
    assert neato.robot.is_turning
    act_until(body, lambda: neato.moves, "it drives")
    body.stop()
    assert not neato.moves
    assert not neato.robot.is_testing
    assert not neato.robot.is_turning
    assert not neato.robot.drive.is_enabled


def test_a_lidar_that_does_not_turn_is_told(neato: NeatoEnd, tmp_path: Path) -> None:
    kind = ROBOTS["neato"]
    neato.simulator.ranges[:] = np.inf
    body = kind.body_on(str(tmp_path / "neato"), kind.config())
    with pytest.raises(NoScanError, match="expected a scan of the lidar"):
        body.start(first_scan=0.0)
    assert not neato.robot.is_testing
