"""Rooms and zones that a person edited are there again when the robot lives again."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import ZoneView
from roomba.commands.play.living import live_client
from roomba.commands.trials.zones import ZONES_NAME
from roomba.files.home_layer import MAP_NAME
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import HOMES
from roomba.headless.live.client import LiveClient
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.storage.zones import save_zones

RUG = ZoneView("rug", "no-go", ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)))


@contextlib.contextmanager
def lived(folder: Path, told: list[str], home: str = "studio") -> Iterator[LiveClient]:
    """A robot that keeps its rooms and zones in a folder."""
    client = live_client(home, seed=1, speed=1.0, knows_map=True)
    client.keep_plan(folder, told.append)
    client.start()
    try:
        yield client
    finally:
        client.end()


def names(client: LiveClient) -> list[str]:
    return [room.name for room in client.home().rooms]


def file_in(folder: Path, name: str) -> Path:
    (file,) = folder.rglob(name)
    return file


def test_edits_are_there_again_and_the_robot_goes_by_them(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path, told) as client:
        x, y = client.home().rooms[0].anchor
        client.split_room(names(client)[0], (x - 20.0, y), (x + 20.0, y))
        client.rename_room(names(client)[0], "Den")
        client.put_zone(RUG)
        rooms = client.home().rooms
    with lived(tmp_path, told) as client:
        assert client.home().rooms == rooms
        assert client.home().zones == (RUG,)
        context = client.ask(lambda robot: robot.mission.context)
        assert context.rooms is not None
        assert "Den" in context.rooms.names
        assert context.zones.names == ("rug",)
        client.remove_zone("rug")
    with lived(tmp_path, told) as client:
        assert client.home().zones == ()
    assert not told


def test_another_home_has_its_own(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path, told) as client:
        client.put_zone(RUG)
    with lived(tmp_path, told, "flat") as client:
        assert client.home().zones == ()
    assert not told


def test_without_edits_nothing_is_kept(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path, told) as client, pytest.raises(RequestRefusedError):
        client.rename_room("no such room", "Den")
    assert not list(tmp_path.rglob("*.yaml"))


def test_what_the_disk_refuses_is_not_changed(tmp_path: Path) -> None:
    folder, told = tmp_path / "plans", list[str]()
    with lived(folder, told) as client:
        before = client.home()
        folder.write_text("no folder", "utf-8")
        with pytest.raises(RequestRefusedError, match=r"cannot be kept: .*nothing was changed"):
            client.put_zone(RUG)
        with pytest.raises(RequestRefusedError, match=r"cannot be kept: .*nothing was changed"):
            client.rename_room(before.rooms[0].name, "Den")
        assert client.home() == before


def test_damaged_rooms_are_told_and_damaged_zones_hold_it_up(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path, told) as client:
        before = client.home().rooms
        client.rename_room(before[0].name, "Den")
        client.put_zone(RUG)
    file_in(tmp_path, "rooms.yaml").write_text("damaged", "utf-8")
    with lived(tmp_path, told) as client:
        assert client.home().rooms == before
    assert told[-1].startswith("the rooms are as without edits: ")
    file_in(tmp_path, "zones.yaml").write_text("damaged", "utf-8")
    aside = file_in(tmp_path, "zones.yaml").with_name("zones.yaml.damaged")
    for _ in range(2):
        with pytest.raises(ZonesError, match=f"mend {aside}"), lived(tmp_path, told):
            pass
    aside.unlink()
    with lived(tmp_path, told) as client:
        assert client.home().zones == ()


def test_zones_of_the_home_count_until_some_are_edited(tmp_path: Path) -> None:
    home, told = tmp_path / "home", [""]
    shutil.copytree(HOMES / "studio", home)
    of_home = Zones((Zone("bowl", ZoneKind.NO_GO, RUG.points),))
    save_zones(of_home, load_map(home / MAP_NAME), home / ZONES_NAME)
    with lived(tmp_path / "kept", told, str(home)) as client:
        assert [zone.name for zone in client.home().zones] == ["bowl"]
        assert client.ask(lambda robot: robot.mission.context).zones.names == ("bowl",)
        client.remove_zone("bowl")
    with lived(tmp_path / "kept", told, str(home)) as client:
        assert client.home().zones == ()
