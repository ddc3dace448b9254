"""Rooms and zones that a person edited are there again when the robot lives again."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import ZoneView
from roomba.commands.play.living import live_client
from roomba.commands.trials.zones import ZONES_NAME
from roomba.configuration.mapping import FloorsConfig
from roomba.files.home_layer import LAYER_NAME, MAP_NAME
from roomba.files.occupancy_map import load_map, save_map
from roomba.files.shipped import HOMES
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.headless.live.client import LiveClient
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.storage.map_bound import map_digest
from roomba.storage.zones import save_zones

RUG = ZoneView("rug", "no-go", ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)))


@contextlib.contextmanager
def lived(folder: Path, told: list[str], home: str = "studio") -> Iterator[LiveClient]:
    """A robot that keeps its rooms and zones in a folder."""
    client = live_client(home, seed=1, speed=1.0, knows_map=True)
    client.keep_plan(folder, FloorsConfig(), told.append)
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
    save_zones(of_home, map_digest(load_map(home / MAP_NAME)), home / ZONES_NAME)
    with lived(tmp_path / "kept", told, str(home)) as client:
        assert [zone.name for zone in client.home().zones] == ["bowl"]
        assert client.ask(lambda robot: robot.mission.context).zones.names == ("bowl",)
        client.remove_zone("bowl")
    with lived(tmp_path / "kept", told, str(home)) as client:
        assert client.home().zones == ()


def changed(folder: Path, change: Callable[[OccupancyMap], OccupancyMap]) -> str:
    """A copy of the studio whose map is another one."""
    shutil.copytree(HOMES / "studio", folder)
    save_map(change(load_map(folder / MAP_NAME)), folder / MAP_NAME)
    return str(folder)


def with_post(occupancy: OccupancyMap) -> OccupancyMap:
    """A map with one cell more that is occupied, in the middle of a room."""
    values = occupancy.values.copy()
    row, column = occupancy.frame.cell_of(2.0, 2.0)
    assert values[row, column] == FREE
    values[row, column] = OCCUPIED
    return OccupancyMap(occupancy.frame, values)


def with_margin(occupancy: OccupancyMap) -> OccupancyMap:
    """A map of the same on a larger grid."""
    frame = occupancy.frame
    larger = GridFrame(
        frame.resolution,
        frame.origin_x - 3 * frame.resolution,
        frame.origin_y,
        frame.rows,
        frame.columns + 3,
    )
    return OccupancyMap(larger, np.pad(occupancy.values, ((0, 0), (3, 0)), constant_values=UNKNOWN))


def test_a_home_that_changed_a_little_keeps_its_rooms_and_zones(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        x, y = client.home().rooms[0].anchor
        client.split_room(names(client)[0], (x - 20.0, y), (x + 20.0, y))
        client.rename_room(names(client)[0], "Den")
        client.put_zone(RUG)
        rooms = names(client)
    assert not told
    home = changed(tmp_path / "home", with_post)
    for _ in range(2):
        with lived(tmp_path / "kept", told, home) as client:
            assert client.home().zones == (RUG,)
            assert names(client) == rooms
            assert client.ask(lambda robot: robot.mission.context).zones.names == ("rug",)
    # Once it is its own, and of that no more is told.
    assert told == ["the map changed since its rooms or zones were edited; they are taken over"]


def test_on_another_grid_zones_and_names_go_on(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.rename_room(names(client)[0], "Den")
        client.put_zone(RUG)
        rooms = names(client)
    with lived(tmp_path / "kept", told, changed(tmp_path / "home", with_margin)) as client:
        (zone,) = client.home().zones
        assert np.allclose(zone.points, RUG.points, atol=0.01)
        assert sorted(names(client)) == sorted(rooms)


def test_of_a_home_that_changed_zones_that_cannot_be_read_hold_it_up(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    file_in(tmp_path / "kept", "zones.yaml").write_text("damaged", "utf-8")
    home = changed(tmp_path / "home", with_post)
    for _ in range(2):
        with pytest.raises(ZonesError, match="mend "), lived(tmp_path / "kept", told, home):
            pass


def test_zones_of_the_home_and_those_taken_over_count_together(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    home = Path(changed(tmp_path / "home", with_post))
    of_home = Zones((Zone("bowl", ZoneKind.NO_GO, RUG.points),))
    save_zones(of_home, map_digest(load_map(home / MAP_NAME)), home / ZONES_NAME)
    with lived(tmp_path / "kept", told, str(home)) as client:
        assert [zone.name for zone in client.home().zones] == ["bowl", "rug"]


def test_what_is_taken_over_and_cannot_be_kept_is_taken_over_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.rename_room(names(client)[0], "Den")
        client.put_zone(RUG)
    home = changed(tmp_path / "home", with_post)
    with monkeypatch.context() as patched:

        def refuse(*_: object) -> None:
            raise OSError("no space left on device")

        patched.setattr("roomba.headless.live.kept_floor_plan.save_rooms", refuse)
        with lived(tmp_path / "kept", told, home) as client:
            assert client.home().zones == (RUG,)
    assert told[-1].endswith("are not kept: no space left on device")
    with lived(tmp_path / "kept", told, home) as client:
        assert client.home().zones == (RUG,)
        assert "Den" in names(client)


def test_what_is_kept_of_a_map_is_not_touched_by_another_one(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
        client.rename_room(names(client)[0], "Den")
        rooms = client.home().rooms
    home = changed(tmp_path / "home", with_post)
    with lived(tmp_path / "kept", told, home) as client:
        client.put_zone(replace(RUG, name="bowl"))
        client.rename_room("Den", "Study")
    with lived(tmp_path / "kept", told) as client:
        assert client.home().zones == (RUG,)
        assert client.home().rooms == rooms


def test_a_zone_of_the_home_with_the_same_name_stays(tmp_path: Path) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    home = Path(changed(tmp_path / "home", with_post))
    elsewhere = tuple((x + 0.8, y) for x, y in RUG.points)
    of_home = Zones((Zone("rug", ZoneKind.NO_GO, elsewhere),))
    save_zones(of_home, map_digest(load_map(home / MAP_NAME)), home / ZONES_NAME)
    with lived(tmp_path / "kept", told, str(home)) as client:
        zones = {zone.name: zone.points for zone in client.home().zones}
        assert zones == {"rug": elsewhere, "rug 2": RUG.points}


@pytest.mark.parametrize("name", [LAYER_NAME, "map.pgm"])
def test_a_damaged_map_beside_a_plan_is_written_anew(tmp_path: Path, name: str) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    file_in(tmp_path / "kept", name).write_text("damaged", "utf-8")
    with lived(tmp_path / "kept", told) as client:
        assert client.home().zones == (RUG,)
    with lived(tmp_path / "kept", told, changed(tmp_path / "home", with_post)) as client:
        assert client.home().zones == (RUG,)


def test_what_is_kept_without_its_map_gets_it(tmp_path: Path) -> None:
    """As of an older program, or one that was killed between two files."""
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    file_in(tmp_path / "kept", LAYER_NAME).unlink()
    with lived(tmp_path / "kept", told) as client:
        assert client.home().zones == (RUG,)
    with lived(tmp_path / "kept", told, changed(tmp_path / "home", with_post)) as client:
        assert client.home().zones == (RUG,)
    assert len(told) == 1


def test_a_plan_whose_map_cannot_be_kept_is_gone_by_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    with lived(tmp_path / "kept", told) as client:
        client.put_zone(RUG)
    file_in(tmp_path / "kept", LAYER_NAME).unlink()

    def refuse(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr("roomba.headless.live.kept_floor_plan.write_floor", refuse)
    with lived(tmp_path / "kept", told) as client:
        assert client.home().zones == (RUG,)
        with pytest.raises(RequestRefusedError, match="nothing was changed"):
            client.remove_zone("rug")
    assert told[0].endswith("are not kept: no space left on device")
    with lived(tmp_path / "kept", told) as client:
        assert client.home().zones == (RUG,)
