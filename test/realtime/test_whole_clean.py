"""A whole clean by a robot that people own, made up at the end of a line: minutes of real time."""

from __future__ import annotations

import faulthandler
from pathlib import Path

import pytest
from fixtures.robots.faulty_end import FaultyEnd
from fixtures.robots.neato_rig import NeatoEnd, neato_world
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.view import LayerName
from roomba.commands.play.owned import OwnedLife
from roomba.drivers.robots.table import ROBOTS
from roomba.storage.map_store import MapStore

LONGEST = 1500.0
"""s of wall time."""


@pytest.mark.parametrize("baud", [None, 115_200], ids=["usb", "serial"])
def test_it_cleans_a_home_that_it_does_not_know_and_docks(
    baud: int | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # That it takes long is no reason to tell what each thread does.
    faulthandler.cancel_dump_traceback_later()
    monkeypatch.setenv("ROOMBA_MAPS", str(tmp_path / "maps"))
    neato = NeatoEnd(FaultyEnd(tmp_path / "neato", baud), neato_world(is_ideal=False))
    told: list[str] = []
    line, kind = str(tmp_path / "neato"), ROBOTS["neato"]
    life = OwnedLife(kind, line, makes_map=False, tell=told.append)
    client = life.client
    client.start()
    try:
        client.clean(CleanRequest())
        wait_until(lambda: client.robot().last is not None, LONGEST, lambda: str(client.robot()))
        last = client.robot().last
        assert last is not None
        print(
            f"\n{last.outcome.value} ({last.message}): {last.covered:.2f} of {last.wanted:.2f} m2, "
            f"{last.distance:.1f} m in {last.duration:.0f} s; missed {last.missed}"
        )
        truth = neato.simulator.observe()
        print(f"picked up {truth.in_bin:.1f} g; hits {neato.simulator.numbers['hits']:.0f}")
        assert last.outcome.value == "completed"
        assert last.covered > 0.9 * last.wanted
        wait_until(lambda: client.robot().vacuum.phase == "docked", 60.0, "it is docked")
        assert truth.battery.is_docked
        assert client.layer(LayerName.MAP) is not None
    finally:
        life.end()
        neato.close()
    assert MapStore(tmp_path / "maps").load(kind.name).rooms is not None
    assert not told
