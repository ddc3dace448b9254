"""How far apart the scans of a drive are: where they are rare, none is missed at once."""

from __future__ import annotations

import itertools
import statistics
from typing import Final

from roomba.configuration.robot import RobotConfig
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan

_LOOKED_AT: Final = 100
"""Scans; the first of a drive, which tell how far apart they are."""
_LATE: Final = 3.0
"""Spacings without a scan, from which on the lidar is taken to be silent."""


def with_patience(config: RobotConfig, drive: LoggedDrive) -> RobotConfig:
    """Return a configuration that waits for scans as rare as those of the drive.

    That of the robot expects several a second, and goes by wheels and gyro when they stay away.
    """
    scans = (each.stamp for each in drive.readings() if isinstance(each.value, LidarScan))
    stamps = list(itertools.islice(scans, _LOOKED_AT))
    spacings = [later - earlier for earlier, later in itertools.pairwise(stamps)]
    patience = _LATE * statistics.median(spacings) if spacings else 0.0
    timeout = max(config.localization.scan_timeout, patience)
    localization = config.localization.model_copy(update={"scan_timeout": timeout})
    return config.model_copy(update={"localization": localization})
