"""Work is counted from look to look while brush and fan are on, and is on the disk."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.client.view import RobotView
from roomba.configuration.household import UpkeepConfig
from roomba.household.folder import KeptValues
from roomba.household.upkeep_keeper import UpkeepKeeper
from roomba.upkeep.parts import HOUR, Part


def keeper_in(folder: Path, robot: WrittenRobot | None = None) -> UpkeepKeeper:
    kept = KeptValues(folder / "upkeep.json", lambda text: pytest.fail(text))
    return UpkeepKeeper(robot or WrittenRobot(), kept, UpkeepConfig(), 100.0)


def seen(time: float, phase: str = "cleaning", dirt: float = 0.0) -> RobotView:
    return replace(VIEW, time=time, dirt=dirt, vacuum=replace(VIEW.vacuum, phase=phase))


def worked(keeper: UpkeepKeeper, part: Part = Part.BRUSH) -> float:
    """Return how long a part worked, s."""
    (state,) = [each for each in keeper.states() if each.part is part]
    return (state.life - state.left) * HOUR


def test_work_counts_while_the_brush_turns(tmp_path: Path) -> None:
    keeper = keeper_in(tmp_path)
    for time, phase in ((0, "docked"), (10, "docked"), (20, "cleaning"), (50, "cleaning")):
        keeper.look(seen(time, phase))
    for time, phase in ((60, "returning"), (90, "returning"), (95, "cleaning"), (96, "cleaning")):
        keeper.look(seen(time, phase))
    assert worked(keeper) == pytest.approx(31.0)


def test_a_clock_that_jumps_counts_nothing(tmp_path: Path) -> None:
    keeper = keeper_in(tmp_path)
    for time in (100.0, 5.0, 6.0, 100_000.0, 100_002.0):
        keeper.look(seen(time))
    assert worked(keeper) == pytest.approx(3.0)


def test_it_is_on_the_disk_when_the_work_pauses_and_every_two_minutes(tmp_path: Path) -> None:
    keeper = keeper_in(tmp_path)
    keeper.look(seen(0))
    keeper.look(seen(100))
    assert worked(keeper_in(tmp_path)) == 0.0
    keeper.look(seen(130))
    assert worked(keeper_in(tmp_path)) == pytest.approx(130.0)
    keeper.look(seen(140))
    keeper.look(seen(141, "returning"))
    assert worked(keeper_in(tmp_path)) == pytest.approx(140.0)
    keeper.look(seen(150))
    keeper.look(seen(151))
    keeper.end()
    assert worked(keeper_in(tmp_path)) == pytest.approx(141.0)


def test_a_reset_is_kept_and_the_robot_hears_of_its_bin(tmp_path: Path) -> None:
    robot = WrittenRobot()
    keeper = keeper_in(tmp_path, robot)
    keeper.look(seen(0, dirt=0.0))
    keeper.look(seen(600, dirt=30.0))
    keeper.reset(Part.BRUSH)
    assert robot.told == []
    keeper.reset(Part.BIN)
    assert robot.told == [("empty_bin", ())]
    again = keeper_in(tmp_path)
    assert (worked(again, Part.BRUSH), worked(again, Part.FILTER)) == (
        0.0,
        pytest.approx(600.0),
    )
    (bin_state,) = [each for each in again.states() if each.part is Part.BIN]
    assert bin_state.share == 1.0
    assert bin_state.life == pytest.approx(100.0 / 180.0)


def test_a_damaged_file_gives_way_to_the_one_before(tmp_path: Path) -> None:
    keeper = keeper_in(tmp_path)
    keeper.look(seen(0))
    keeper.look(seen(200))
    keeper.look(seen(400))
    (tmp_path / "upkeep.json").write_text("{}\n# kept 1 sha256 0\n", "utf-8")
    told: list[str] = []
    again = UpkeepKeeper(
        WrittenRobot(), KeptValues(tmp_path / "upkeep.json", told.append), UpkeepConfig(), 100.0
    )
    assert worked(again) == pytest.approx(200.0)
    assert "the one from before is used" in told[0]
