"""A made-up robot behind OpenNeato's bridge: started by the bridge's address, and released."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from fixtures.robots.neato_rig import neato_world
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.commands.play.owned import OwnedLife
from roomba.drivers.robots.table import ROBOTS
from roomba.emulators.neato.bridge import NeatoBridge
from roomba.emulators.neato.robot import NeatoRobot


def test_it_drives_maps_cleans_and_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROOMBA_MAPS", str(tmp_path / "maps"))
    told: list[str] = []
    simulator = neato_world()
    with NeatoBridge(NeatoRobot(simulator)) as bridge:
        life = OwnedLife(ROBOTS["openneato"], bridge.address, makes_map=True, tell=told.append)
        client = life.client
        client.start()
        try:
            client.clean(CleanRequest())
            wait_until(lambda: client.robot().vacuum.covered > 0.1, 120.0, "some clean floor")
            now, true = client.robot(), simulator.home.station.inverse().compose(simulator.pose)
            assert math.dist(now.pose[:2], (true.x, true.y)) < 0.15
            client.pause()

            def stands() -> bool:
                return abs(simulator.observe().twist.linear) < 1e-4

            wait_until(stands, 20.0, "it stands")
        finally:
            life.end()
        assert not bridge.robot.is_testing
        assert not bridge.robot.is_turning
    assert not told
