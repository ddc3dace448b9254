"""``./roomba import valetudo`` and ``export valetudo``: homes to clean, and back."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from roomba.commands.trials.homes import rooms_of
from roomba.commands.trials.runs import TrialSetup
from roomba.commands.trials.trial import Trial
from roomba.commands.valetudo.export_command import main as export
from roomba.commands.valetudo.homes import read_home, write_home
from roomba.commands.valetudo.import_command import main as bring
from roomba.commands.valetudo.zones import taken_zones
from roomba.configuration.body import BodyConfig
from roomba.files.shipped import HOMES
from roomba.files.valetudo.home import ValetudoHome
from roomba.files.valetudo.reading import parse
from roomba.geometry import Pose
from roomba.grid import FREE
from roomba.world.layers.layer import load_home

ROOM = 400
"""cm; the side of a room, walls included."""


def foreign(file: Path) -> Path:
    """Write a map of two rooms with a door, as another program does."""
    side = ROOM // 5
    floor = [[x, y] for y in range(1, side - 1) for x in range(1, 2 * side - 1)]
    wall_x = side
    rooms = [
        [x, y, kind]
        for x, y in floor
        if x != wall_x or side // 2 - 8 < y < side // 2 + 8
        for kind in (x > wall_x,)
    ]
    inside = {(x, y) for x, y, _ in rooms}
    walls = [(x, y) for y in range(side) for x in range(2 * side) if (x, y) not in inside]
    layers = [
        {
            "type": "segment",
            "metaData": {"segmentId": str(number), "name": name},
            "pixels": [value for x, y, kind in rooms if kind == number for value in (x, y)],
        }
        for number, name in ((0, "Büro"), (1, "Bad"))
    ]
    layers.append({"type": "wall", "pixels": [value for wall in walls for value in wall]})
    entities = [
        {"type": "charger_location", "points": [25, 200], "metaData": {"angle": 12}},
        {"type": "no_go_area", "points": [600, 20, 780, 20, 780, 100, 600, 100]},
    ]
    values = {
        "size": {"x": 2 * ROOM, "y": ROOM},
        "pixelSize": 5,
        "layers": layers,
        "entities": entities,
        "metaData": {"version": 2},
    }
    file.write_text(json.dumps(values), encoding="utf-8")
    return file


def test_a_foreign_home_is_cleaned_in_simulation(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    assert "2 rooms, 1 zones" in capsys.readouterr().out
    setup = TrialSetup(Trial(home=str(folder), seed=1))
    assert [room.name for room in setup.home.rooms] == ["Büro", "Bad"]
    # It stands by the wall next to which the charger is.
    assert setup.home.station.distance_to(0.0, 0.0) < 0.5
    run = setup.run()
    assert run.figures.is_completed
    assert run.figures.hits == 0
    assert run.figures.fraction > 0.99
    # Its zone was obeyed: the tool was never in the middle of it.
    x, y = 6.9 - 0.25, 2.0 - 0.6
    away = np.hypot(run.trajectory[:, 1] - x, run.trajectory[:, 2] - y)
    assert away.min() > 0.4 + run.robot.body.radius - 0.05


def test_a_home_whose_door_is_shut_is_that_of_the_charger_and_the_rest_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = foreign(tmp_path / "map.json")
    told = json.loads(file.read_text("utf-8"))
    side = ROOM // 5
    # Shut are the door and half of the room of the charger, which is the smallest part.
    shut = [at for x in (side // 2, side) for y in range(side) for at in (x, y)]
    told["layers"].append({"type": "wall", "pixels": shut})
    file.write_text(json.dumps(told), "utf-8")
    folder = tmp_path / "home"
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    assert "cannot be reached from the station" in capsys.readouterr().out
    station = load_home(str(folder), HOMES).station
    assert station.x < 0.5 * ROOM / 100.0 - 0.25


def test_a_virtual_wall_parts_the_home_and_the_station_is_on_the_side_of_the_charger(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """0.6 m from the charger, across its room: the larger side is the other one."""
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    told = json.loads(file.read_text("utf-8"))
    wall = {"type": "virtual_wall", "points": [25 + 60, 0, 25 + 60, 400], "metaData": {}}
    told["entities"].append(wall)
    file.write_text(json.dumps(told), "utf-8")
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    assert "cannot be reached from the station" in capsys.readouterr().out
    station = load_home(str(folder), HOMES).station
    assert station.x + BodyConfig().radius < 0.6


def test_where_the_station_of_a_map_without_one_was_put_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    told = json.loads(file.read_text("utf-8"))
    told["entities"] = []
    file.write_text(json.dumps(told), "utf-8")
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    station = load_home(str(folder), HOMES).station
    said = capsys.readouterr().out
    assert f"station at ({station.x:.2f}, {station.y:.2f}), where it was put" in said
    assert "no charger" in said


def test_a_home_comes_back_as_it_was_exported(tmp_path: Path) -> None:
    file, folder = tmp_path / "flat.json", tmp_path / "flat"
    assert export(["valetudo", "flat", "--out", str(file)]) == 0
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    before, after = read_home("flat"), read_home(str(folder))
    assert_same(before, after)


def test_a_home_with_zones_comes_back_with_them(tmp_path: Path) -> None:
    found = parse(foreign(tmp_path / "map.json").read_text(encoding="utf-8"))
    home = write_home(found, taken_zones(found).zones, tmp_path / "one")
    file = tmp_path / "again.json"
    assert export(["valetudo", str(tmp_path / "one"), "--out", str(file)]) == 0
    again = parse(file.read_text(encoding="utf-8"))
    assert again.has_own_frame
    assert np.allclose(again.no_go, found.no_go)
    assert again.station is not None
    assert again.station.distance_to(home.station.x, home.station.y) < 0.01
    write_home(again, taken_zones(again).zones, tmp_path / "two")
    assert_same(read_home(str(tmp_path / "one")), read_home(str(tmp_path / "two")))


def test_a_room_within_another_one_is_a_room_of_its_own(tmp_path: Path) -> None:
    found = parse(foreign(tmp_path / "map.json").read_text(encoding="utf-8"))
    (name, around), other = found.rooms
    closet = np.zeros_like(around)
    closet[40:60, 30:50] = True
    rooms = (name, around & ~closet), ("Kammer", closet), other
    home = write_home(replace(found, rooms=rooms), taken_zones(found).zones, tmp_path / "home")
    made = rooms_of(home)
    assert made.names == ("Büro", "Kammer", "Bad")
    assert np.count_nonzero(made.labels == 2) == np.count_nonzero(closet)


def assert_same(before: ValetudoHome, after: ValetudoHome) -> None:
    # The station itself is solid in the home's map, and so part of the exported one.
    assert after.occupancy.frame == before.occupancy.frame
    assert ((after.occupancy.values == FREE) == (before.occupancy.values == FREE)).all()
    assert isinstance(before.station, Pose)
    assert isinstance(after.station, Pose)
    assert after.station.distance_to(before.station.x, before.station.y) < 0.0101
    turned = math.remainder(after.station.theta - before.station.theta, 2.0 * math.pi)
    assert abs(turned) < 0.01
    assert [name for name, _ in after.rooms] == [name for name, _ in before.rooms]
    for (_, one), (_, two) in zip(before.rooms, after.rooms, strict=True):
        assert np.count_nonzero(one ^ two) < 0.005 * np.count_nonzero(one)
    assert np.allclose(np.ravel(before.no_go), np.ravel(after.no_go), atol=0.0101)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"{}", "expected a map of Valetudo"),
        (b" \n", "the file is empty"),
        (b"\xff\xfe", "UTF-8"),
        (b"\x1f\x8b\x08\x00", "unpack it: gunzip"),
        (None, "No such file"),
    ],
)
def test_what_is_no_map_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes | None, reason: str
) -> None:
    file = tmp_path / "map.json"
    if content is not None:
        file.write_bytes(content)
    assert bring(["valetudo", str(file), "--out", str(tmp_path / "home")]) == 2
    told = capsys.readouterr().err
    assert reason in told
    assert told.count("\n") == 1
    assert not (tmp_path / "home").exists()


@pytest.mark.parametrize(
    ("entity", "points", "told"),
    [
        # Corners crosswise, a wall of one point, an area of a line, and of one point.
        ("no_go_area", [100, 100, 200, 200, 200, 100, 100, 200], "2 zones, "),
        ("virtual_wall", [100, 90, 100, 90], "1 zones (1 of no size left out: wall 1)"),
        ("no_go_area", [100, 90, 200, 90, 200, 90, 100, 90], "left out: no-go 2)"),
        ("no_go_area", 4 * [100, 90], "left out: no-go 2)"),
    ],
)
def test_odd_zones_refuse_no_map(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    entity: str,
    points: list[int],
    told: str,
) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    with_entity(file, entity, points)
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    assert told in capsys.readouterr().out


def with_entity(file: Path, entity: str, points: list[int], times: int = 1) -> None:
    values = json.loads(file.read_text("utf-8"))
    values["entities"] += times * [{"type": entity, "points": points}]
    file.write_text(json.dumps(values), "utf-8")


def test_an_area_whose_corners_are_told_crosswise_is_the_whole_rectangle(tmp_path: Path) -> None:
    file = foreign(tmp_path / "map.json")
    with_entity(file, "no_go_area", [100, 100, 200, 250, 200, 100, 100, 250])
    zones = taken_zones(parse(file.read_text("utf-8"))).zones
    assert zones.all[1].shape.area == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("points", "times", "reason"),
    [
        ([0, 0, 90, 90, 0, 90, 90, 0, 40, 70], 1, "zone 'no-go 2': .*; delete it in Valetudo"),
        ([0, 0, 90, 0, 90, 90], 1000, "most 1000 zones, got 1001; delete some in Valetudo"),
    ],
)
def test_zones_that_cannot_be_taken_are_refused_with_what_to_do(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    points: list[int],
    times: int,
    reason: str,
) -> None:
    file = foreign(tmp_path / "map.json")
    with_entity(file, "no_go_area", points, times)
    assert bring(["valetudo", str(file), "--out", str(tmp_path / "home")]) == 2
    assert re.search(reason, capsys.readouterr().err)


def test_of_a_map_that_is_refused_nothing_is_left_and_the_next_one_is_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "made" / "home"
    whole = file.read_text("utf-8")
    told = json.loads(whole)
    told["layers"] = [{"type": "floor", "pixels": [40, 40, 41, 40]}]
    words = ["valetudo", str(file), "--out", str(folder)]
    file.write_text(json.dumps(told), "utf-8")
    assert bring(words) == 2
    refused = capsys.readouterr().err
    assert f"{file}: expected" in refused
    assert "home.yaml" not in refused
    assert list(tmp_path.iterdir()) == [file]
    file.write_text(whole, "utf-8")
    assert bring(words) == 0
    assert {each.name for each in folder.iterdir()} == {
        "home.yaml",
        "map.pgm",
        "map.yaml",
        "zones.yaml",
    }


def test_a_home_goes_into_a_folder_that_is_there(tmp_path: Path) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    assert bring(["valetudo", str(file), "--out", str(folder)]) == 0
    assert (folder / "notes.txt").read_text() == "mine"
    assert load_home(str(folder), HOMES).name == "home"


def test_a_home_that_is_there_is_not_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, folder = foreign(tmp_path / "map.json"), tmp_path / "home"
    words = ["valetudo", str(file), "--out", str(folder)]
    assert bring(words) == 0
    (folder / "map.yaml").write_text("mine")
    with pytest.raises(SystemExit) as ended:
        bring(words)
    assert ended.value.code == 2
    assert f"--out: expected a folder without a home, got {folder}" in capsys.readouterr().err
    assert (folder / "map.yaml").read_text() == "mine"


def test_a_file_in_place_of_the_folder_is_refused_by_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = foreign(tmp_path / "map.json")
    with pytest.raises(SystemExit) as ended:
        bring(["valetudo", str(file), "--out", str(file)])
    assert ended.value.code == 2
    assert f"--out: expected a folder, or a new one, got the file {file}" in capsys.readouterr().err


def test_a_home_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert export(["valetudo", "castle", "--out", str(tmp_path / "x.json")]) == 2
    assert "castle" in capsys.readouterr().err
