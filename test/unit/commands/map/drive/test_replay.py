"""A drive through the mapper: what odometry does not tell is taken from scans."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives.made_logs import BEAMS, BEGAN, Item, changed, drive, held, pose_at, write_bag

from roomba.commands.map.drive.mapped import MappedDrive, mapped_drive
from roomba.geometry import Pose
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.submaps.heading_drift import HeadingDrift
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.readings import Lifted

SECONDS = 40.0
SLIP = Pose(4.0, -3.0, 2.0)
BEGIN = pose_at(0.0).inverse()


def mapped(path: Path, items: list[Item]) -> MappedDrive:
    wanted = Wanted()
    return mapped_drive([write_bag(path / "made.bag", items)], wanted, lambda share, words: None)


def off(made: MappedDrive, after: float = 0.0) -> float:
    """Return the largest distance from the true way after so many s, m."""
    rows = made.trajectory[made.trajectory[:, 0] >= BEGAN + after]
    true = [BEGIN.compose(pose_at(stamp - BEGAN)) for stamp in rows[:, 0].tolist()]
    ways = rows[:, 1:3] - [(pose.x, pose.y) for pose in true]
    return float(np.hypot(*ways.T).max())


@pytest.mark.parametrize("goes_on_there", [True, False])
def test_odometry_that_stands_still_for_a_while_bends_nothing(
    tmp_path: Path, goes_on_there: bool
) -> None:
    made = mapped(
        tmp_path, changed(drive(SECONDS), "/odom", held(10.0, 25.0, goes_on_there=goes_on_there))
    )
    assert off(made) < 0.05
    assert len(made.trajectory) == 200
    assert any("stands still or is missing for 15 s" in note for note in made.notes)


def test_of_odometry_that_ends_no_scan_is_lost(tmp_path: Path) -> None:
    items = [item for item in drive(SECONDS) if item.topic == "/scan" or item.stamp < BEGAN + 15.0]
    made = mapped(tmp_path, items)
    assert made.replay.scans == 200
    assert off(made) < 0.05
    assert any("it ends before the scans do" in note for note in made.notes)
    assert made.replay.has_odometry


def test_what_it_sees_while_it_is_carried_is_left_out(tmp_path: Path) -> None:
    items = drive(SECONDS)
    for passed, is_lifted in ((12.03, True), (14.03, False)):
        stamp = BEGAN + passed
        items.append(Item("/wheel_drop", Lifted(is_lifted), stamp, stamp + 0.02))
    made = mapped(tmp_path, sorted(items, key=lambda item: item.arrival))
    assert any("10 scans while it was carried" in note for note in made.notes)
    assert made.replay.scans == 190
    assert off(made) < 0.05


def test_a_plain_drive_has_no_notes(tmp_path: Path) -> None:
    made = mapped(tmp_path, drive(SECONDS))
    assert made.notes == ()
    assert off(made) < 0.03


def test_a_drive_whose_scans_fit_nothing_is_told_to_make_no_map(tmp_path: Path) -> None:
    generator = np.random.default_rng(3)

    def circle(_: int, item: Item) -> Item:
        return replace(item, value=np.full(BEAMS, generator.uniform(0.5, 9.0)))

    made = mapped(tmp_path, changed(drive(SECONDS), "/scan", circle))
    assert made.replay.unconfirmed > 100
    told = f"{made.replay.unconfirmed} of {made.replay.scans} scans fitted nothing seen before"
    assert any(told in note for note in made.notes)


def test_wheels_that_slip_are_told_from_when_to_when(tmp_path: Path) -> None:
    def slipping(_: int, item: Item) -> Item:
        passed = item.stamp - BEGAN
        return replace(
            item, value=BEGIN.compose(pose_at(passed + 2.0 * np.clip(passed - 12.0, 0.0, 8.0)))
        )

    made = mapped(tmp_path, changed(drive(SECONDS), "/odom", slipping))
    assert off(made) < 0.05
    (told,) = [note for note in made.notes if "disagree about the way" in note]
    begin, end = (float(word) for word in told.split("way from ")[1].split(" s ")[0].split(" to "))
    assert begin == pytest.approx(12.0, abs=3.0)
    assert end == pytest.approx(20.0, abs=3.0)


@pytest.mark.parametrize(("degrees", "is_told"), [(1.9, False), (4.5, True)])
def test_a_map_that_may_be_bent_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, degrees: float, is_told: bool
) -> None:
    drift = HeadingDrift(math.radians(degrees), 41.8)
    monkeypatch.setattr(Mapper, "heading_drift", property(lambda _: drift))
    notes = mapped(tmp_path, drive(10.0)).notes
    assert any("± 9 degrees" in note and "after 42 m" in note for note in notes) == is_told


def test_after_a_pause_what_was_seen_before_is_found_where_odometry_is_wrong(
    tmp_path: Path,
) -> None:
    """It drives on while nothing is recorded, and slips."""

    def slipped(_: int, item: Item) -> Item:
        assert isinstance(item.value, Pose)
        return item if item.stamp < BEGAN + 20.0 else replace(item, value=SLIP.compose(item.value))

    items = [item for item in drive(SECONDS) if not 15.0 < item.stamp - BEGAN < 30.0]
    made = mapped(tmp_path, changed(items, "/odom", slipped))
    assert made.replay.mapper.ways_apart == []
    assert off(made, 32.0) < 0.05
    assert any("or driven while nothing was recorded" in note for note in made.notes)
