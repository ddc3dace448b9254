"""A Create 2 without a lidar, made up by the command, brought to life on its line."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.view import LayerName
from roomba.commands.play.bumping import BumpingLife
from roomba.drivers.robots.table import ROBOTS
from roomba.headless.live.bumping.client import BumpingClient


@pytest.fixture
def client(tmp_path: Path) -> Iterator[BumpingClient]:
    line = tmp_path / "create2"
    emulate = (sys.executable, "-m", "roomba.commands.program", "emulate", "create2", "--seed", "1")
    made = Program((*emulate, "--link", str(line)), os.environ, tmp_path / "log")
    wait_until(line.exists, 60.0, lambda: made.output)
    life = BumpingLife(ROBOTS["create2"], str(line))
    life.client.start()
    yield life.client
    life.end()
    made.clean_up()


def test_it_leaves_its_station_sweeps_and_comes_home_by_beams(client: BumpingClient) -> None:
    def phase() -> str:
        return client.robot().vacuum.phase

    wait_until(lambda: phase() == "docked", 10.0, phase)
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().vacuum.covered > 1.0, 90.0, lambda: str(client.robot()))
    assert phase() == "cleaning"
    swept = client.layer(LayerName.COVERAGE)
    assert swept is not None
    assert swept.cells.any()
    client.dock()
    wait_until(lambda: phase() == "docked", 540.0, phase)
    assert client.robot().charges
