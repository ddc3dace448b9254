"""A drive with rare scans is localized by its scans, not by wheels and gyro alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.drives.made_logs import Item, drive, write_bag

from roomba.commands.localize.scan_spacing import with_patience
from roomba.configuration.robot import RobotConfig
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.drives.drive import LoggedDrive

CONFIG = RobotConfig()


def rare(every: int) -> list[Item]:
    """Return a drive of which one of so many scans is left."""
    items, scans = [], 0
    for item in drive(20.0):
        if item.topic == "/scan":
            scans += 1
            if scans % every:
                continue
        items.append(item)
    return items


@pytest.mark.parametrize(
    ("every", "timeout"), [(1, CONFIG.localization.scan_timeout), (5, 3.0), (15, 9.0)]
)
def test_it_waits_for_scans_as_rare_as_those_of_the_drive(
    every: int, timeout: float, tmp_path: Path
) -> None:
    bag = write_bag(tmp_path / "rare.bag", rare(every))
    with LoggedDrive((bag,), Wanted()) as recorded:
        patient = with_patience(CONFIG, recorded)
    assert patient.localization.scan_timeout == pytest.approx(timeout, abs=0.01)
    assert patient.localization.model_copy(
        update={"scan_timeout": CONFIG.localization.scan_timeout}
    ) == (CONFIG.localization)


def test_a_drive_without_scans_changes_nothing(tmp_path: Path) -> None:
    odometry = [item for item in drive(2.0) if item.topic != "/scan"]
    first_scan = next(item for item in drive(2.0) if item.topic == "/scan")
    bag = write_bag(tmp_path / "one.bag", [first_scan, *odometry])
    with LoggedDrive((bag,), Wanted()) as recorded:
        assert with_patience(CONFIG, recorded) == CONFIG
