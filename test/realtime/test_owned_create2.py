"""A Create 2 with an LD19, made up by the command, brought to life on two lines."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.view import LayerName
from roomba.commands.play.owned import OwnedLife
from roomba.drivers.robots.table import ROBOTS
from roomba.headless.live.client import LiveClient


@pytest.fixture
def client(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[LiveClient]:
    monkeypatch.setenv("ROOMBA_MAPS", str(tmp_path / "maps"))
    line, lidar = tmp_path / "create2", tmp_path / "ld19"
    emulate = (sys.executable, "-m", "roomba.commands.program", "emulate", "create2", "--seed", "1")
    made = Program(
        (*emulate, "--link", str(line), "--lidar-link", str(lidar)), os.environ, tmp_path / "log"
    )
    wait_until(lambda: line.exists() and lidar.exists(), 60.0, lambda: made.output)
    told: list[str] = []
    life = OwnedLife(
        ROBOTS["create2"], str(line), makes_map=False, tell=told.append, lidar_line=str(lidar)
    )
    life.client.start()
    yield life.client
    life.end()
    made.clean_up()
    assert not told


def test_it_leaves_its_station_maps_cleans_and_stands(client: LiveClient) -> None:
    assert client.robot().vacuum.phase == "docked"
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().vacuum.covered > 0.3, 90.0, lambda: str(client.robot()))
    map_ = client.layer(LayerName.MAP)
    assert map_ is not None
    assert (map_.cells == 1).sum() * map_.resolution**2 > 4.0
    assert len(client.robot().scan) > 100
    client.pause()

    def stands() -> bool:
        x, y, _ = client.robot().pose
        wait_until(lambda: client.robot().vacuum.phase == "paused", 10.0, "it is paused")
        return math.dist(client.robot().pose[:2], (x, y)) < 0.002

    wait_until(stands, 20.0, "it stands")
