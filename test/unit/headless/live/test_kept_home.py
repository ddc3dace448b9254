"""The map that a live robot makes is kept, with its rooms and zones."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.waiting import wait_until

from roomba.client.view import ZoneView
from roomba.commands.play.living import live_client
from roomba.headless.live.kept_home import KeptHome
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.storage.map_store import MapStore

CARPETS = FeltCarpets((((1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 1.0)),))
LOW = LowThings((LowThing(1.0, 1.0, 1.1, 1.0, 4),))
DEADLINE = 20.0
"""s of wall time."""


def test_it_is_kept_once_it_is_whole_and_whenever_rooms_or_zones_change(tmp_path: Path) -> None:
    store, told = MapStore(tmp_path), list[str]()
    client = live_client("studio", seed=1, speed=100.0, knows_map=False)
    kept = KeptHome(store, "mine", told.append)
    assert kept.load() is None
    kept.start(client)
    client.start()
    try:
        client.explore()
        assert store.names() == ()
        wait_until(lambda: store.names() == ("mine",), DEADLINE, "a kept map")
        wait_until(lambda: client.home().rooms, DEADLINE, "rooms")
        name = client.home().rooms[0].name
        client.rename_room(name, "den")
        client.ask(lambda robot: setattr(robot.mission.obstacles, "low", LOW))
        client.ask(lambda robot: robot.mission.carpets.recall(CARPETS))
        client.put_zone(ZoneView("vase", "no-go", ((1.0, 1.0), (1.5, 1.0), (1.5, 1.5))))
    finally:
        client.end()
        kept.stop()
    assert not told
    again = KeptHome(store, "mine", told.append).load()
    assert again is not None
    assert again.rooms is not None
    assert "den" in again.rooms.names
    assert again.zones.names == ("vase",)
    assert (again.low_things, again.carpets) == (LOW, CARPETS)
    station = client.home().station
    assert (again.station.x, again.station.y) == pytest.approx(station[:2])


def test_what_the_disk_refuses_is_told(tmp_path: Path) -> None:
    file, told = tmp_path / "no_folder", list[str]()
    file.write_text("a file", "utf-8")
    client = live_client("studio", seed=1, speed=1.0, knows_map=True)
    kept = KeptHome(MapStore(file), "mine", told.append)
    kept.start(client)
    client.start()
    wait_until(lambda: told, DEADLINE, "it is told")
    client.end()
    kept.stop()
    assert told[0].startswith("the map is not kept: ")
