"""Floor to which no way leads: it is reported, with its place, if it is as large as a room."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from roomba.commands.sim import command
from roomba.commands.trials.runs import docking_config, mission_config, robot_config_of
from roomba.commands.trials.trial import Trial
from roomba.commands.trials.unreached import NOTHING, Unreached, unreached_in
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones

ROBOT = robot_config_of(Trial())
WALL = Zone("behind", ZoneKind.WALL, ((2.0, 0.0), (2.0, 2.0)))
AREA = Zone("kept out", ZoneKind.NO_GO, ((1.9, 0.0), (4.0, 0.0), (4.0, 2.0), (1.9, 2.0)))


def two_rooms(wall: float | None = None, second: float = 4.0) -> OccupancyMap:
    """Return 2 m of floor from left to right, up to ``second``; at ``wall``, m, is one without a
    door.
    """
    frame = GridFrame(0.05, 0.0, 0.0, 40, 80)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[1:-1, 1 : round(second / 0.05) - 1] = FREE
    if wall is not None:
        values[:, round(wall / 0.05)] = OCCUPIED
    return OccupancyMap(frame, values)


def context_of(occupancy: OccupancyMap, *zones: Zone) -> PlanningContext:
    labels = np.where(occupancy.values == FREE, np.int16(1), np.int16(0))
    labels[:, 40:][labels[:, 40:] == 1] = 2
    return PlanningContext(
        occupancy,
        Pose(0.3, 1.0, np.pi),
        ROBOT,
        mission_config(ROBOT),
        docking_config(),
        Rooms(occupancy.frame, labels, ("hall", "bath")),
        Zones(zones),
    )


@pytest.mark.parametrize("zones", [(), (WALL,)], ids=["a wall", "a virtual wall"])
def test_a_room_behind_a_wall_is_told(zones: tuple[Zone, ...]) -> None:
    found = unreached_in(context_of(two_rooms(None if zones else 2.0), *zones))
    assert found.rooms == ("bath",)
    # 1.9 m x 1.8 m, but for what the tool does not reach at walls.
    assert 3.0 < found.area < 3.4
    assert found.words == f"{found.area:.1f} m² of floor in bath cannot be reached from the station"


@pytest.mark.parametrize(
    ("occupancy", "zones"),
    [(two_rooms(), ()), (two_rooms(2.0, second=2.5), ()), (two_rooms(), (AREA,))],
    ids=["all is reached", "a pocket", "a zone that is kept out of"],
)
def test_else_nothing_is_told(occupancy: OccupancyMap, zones: tuple[Zone, ...]) -> None:
    assert unreached_in(context_of(occupancy, *zones)) == NOTHING
    assert NOTHING.words == ""


def test_pockets_are_told_by_what_they_are_together() -> None:
    occupancy = two_rooms(2.0)
    for place in (16, 24):  # nine pieces of 0.3 m² and more
        occupancy.values[place, 40:] = OCCUPIED
    for wall in (2.6, 3.2):
        occupancy.values[:, round(wall / 0.05)] = OCCUPIED
    found = unreached_in(context_of(occupancy))
    assert found.rooms == ("bath",)
    assert 1.0 < found.area < 3.0


def test_many_rooms_are_counted() -> None:
    assert Unreached(77.24, ("a", "b")).words == (
        "77.2 m² of floor in 2 rooms cannot be reached from the station"
    )


def test_what_lies_in_rooms_that_are_not_named_is_told() -> None:
    assert Unreached(3.3, ("bath",), 1.2).words == (
        "3.3 m² of floor in bath and other places cannot be reached from the station"
    )


def test_a_run_tells_it_in_a_line_and_in_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save_map(two_rooms(2.0), tmp_path / "map.yaml")
    file = tmp_path / "run.json"
    assert command.main(["--home", str(tmp_path), "--no-history", "--json", str(file)]) == 0
    assert "cannot be reached from the station" in capsys.readouterr().out
    told = json.loads(file.read_text("utf-8"))["unreached"]
    assert 3.0 < told["area_m2"] < 3.4
