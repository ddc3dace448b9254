"""How far apart in time the scans of a drive are; where they are rare, none is missing at once."""

from __future__ import annotations

import itertools
import statistics
from typing import Final

from roomba.configuration.robot import RobotConfig
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan

_LOOKED_AT: Final = 100
"""The first scans of a drive, from which the time between scans is known."""
_LATE: Final = 3.0
"""Spacings without a scan after which the lidar counts as silent."""


def with_patience(config: RobotConfig, drive: LoggedDrive) -> RobotConfig:
    """Return a configuration that waits for scans as rare as those of the drive.

    The robot's own configuration expects several scans a second; without them the localizer goes by
    wheels and gyro alone.
    """
    scans = (each.stamp for each in drive.readings() if isinstance(each.value, LidarScan))
    stamps = list(itertools.islice(scans, _LOOKED_AT))
    spacings = [later - earlier for earlier, later in itertools.pairwise(stamps)]
    patience = _LATE * statistics.median(spacings) if spacings else 0.0
    timeout = max(config.localization.scan_timeout, patience)
    localization = config.localization.model_copy(update={"scan_timeout": timeout})
    return config.model_copy(update={"localization": localization})
