"""Checks a drive before it is mapped: facts that are missing in the logs, or wrong there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_gyro import gyro_fault
from roomba.commands.map.drive.shown.shown_mount import ShownMount, shown_mount
from roomba.commands.map.drive.shown.shown_odometry import odometry_fault, shown_headings
from roomba.commands.map.drive.shown.shown_sweep import shown_sweep
from roomba.geometry import Pose
from roomba.perception.matching.mounts import UPRIGHT, UPSIDE_DOWN, Mount
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.drives.fixed_beams import fixed_beams
from roomba.recordings.drives.mounting import degrees_aside
from roomba.recordings.readings import UNUSABLE_ODOMETRY, Kind

_ANOTHER_WAY: Final = 0.25
"""rad; a lidar whose scans show it turned by more does not look ahead. A smaller angle is an
inaccurate mounting, which the map's calibration measures."""


def look_at_drive(drive: LoggedDrive) -> None:
    """Find out faults of odometry and lidar; correct the drive's reading, and report them."""
    if not drive.chosen.has_odometry:
        return
    all_samples = samples = LidarSamples(drive.readings())
    hidden = hidden_beams(all_samples, [sample.pose[2] for sample in all_samples.scans])
    if hidden.any():
        drive.leave_beams(hidden)
        samples = LidarSamples(drive.readings())
    fault = _odometry_fault(drive, samples)
    if fault and hidden.any():
        # The hidden beams were found by headings of a faulty odometry.
        hidden = hidden_beams(all_samples, shown_headings(samples))
        drive.leave_beams(hidden)
        samples = LidarSamples(drive.readings())
    if hidden.any():
        drive.remark(_told_hidden(all_samples, hidden))
    if fault and not drive.keeps_odometry:
        drive.leave_odometry(fault)
        return
    if fault:
        drive.remark(f"the odometry is doubtful: {fault}")
    _look_at_lidar(drive, samples)
    if drive.chosen.name(Kind.GYRO) is not None:
        _look_at_gyro(drive)


def hidden_beams(samples: LidarSamples, headings: Sequence[float]) -> Mask:
    """Return which beams hit a thing on the robot itself in most scans, [beams].

    ``headings`` are the robot's at the scans, rad, not wrapped. Without scans there are no beams.
    """
    beams = _usual_beams(samples)
    alike = [
        (sample.scan.ranges, heading)
        for sample, heading in zip(samples.scans, headings, strict=True)
        if sample.scan.lidar.beams == beams
    ]
    if not alike:
        return np.zeros(0, np.bool_)
    ranges, of_them = zip(*alike, strict=True)
    return fixed_beams(np.array(ranges), np.array(of_them))


def _usual_beams(samples: LidarSamples) -> int:
    """Return how many beams most scans have; 0 without scans."""
    sizes = Counter(sample.scan.lidar.beams for sample in samples.scans)
    return max(sizes, key=sizes.__getitem__, default=0)


def _told_hidden(samples: LidarSamples, hidden: Mask) -> str:
    """Return a remark about beams, [beams], that a thing on the robot hides."""
    ranges = np.array(
        [
            sample.scan.ranges[hidden]
            for sample in samples.scans
            if len(sample.scan.ranges) == len(hidden)
        ]
    )
    away = float(np.median(ranges[np.isfinite(ranges)]))
    return (
        f"{np.count_nonzero(hidden)} of {len(hidden)} beams show the same wherever the robot turns,"
        f" {away:.2f} m away: something on the robot hides what is there; they are left out"
    )


def _odometry_fault(drive: LoggedDrive, samples: LidarSamples) -> str:
    """Return what is wrong with the odometry; "" if nothing is, or no scans can show it."""
    if samples.has_odometry or not samples.count:
        return odometry_fault(samples)
    reason = drive.reason_of(UNUSABLE_ODOMETRY)
    return "hardly any of it can be used" + (f": {reason}" if reason else "")


def _look_at_lidar(drive: LoggedDrive, samples: LidarSamples) -> None:
    """Find out how the lidar is mounted and how it sweeps.

    A mount that the user gave is kept. Without odometry nothing can be found out.
    """
    shown = shown_mount(samples)
    is_other = shown is not None and _is_other(shown)
    if shown is not None and is_other:
        if drive.is_mount_told:
            drive.remark(_contradiction(shown))
            return
        drive.take_mount(_mount_of(shown))
        samples = LidarSamples(drive.readings())
    sweep = shown_sweep(samples)
    if sweep is None:
        return
    drive.take_sweep(sweep)
    drive.remark(
        "the scans of turns fit the others clearly better if the beams of each were measured "
        f"{sweep}: so they are taken, and not as the driver tells"
    )
    if shown is not None and is_other:
        # Scans that are no longer bent show the mount better.
        drive.take_mount(Mount())
        closer = shown_mount(LidarSamples(drive.readings()))
        drive.take_mount(_mount_of(closer or shown))


def _look_at_gyro(drive: LoggedDrive) -> None:
    """Find out whether the gyro measures turns, by the lidar as it is read by now."""
    fault = gyro_fault(LidarSamples(drive.readings()))
    if fault and drive.keeps_gyro:
        drive.remark(f"the gyro is doubtful: {fault}")
    elif fault:
        drive.leave_gyro(fault)


def _is_other(shown: ShownMount) -> bool:
    return shown.is_turned_over or abs(shown.yaw) > _ANOTHER_WAY


def _mount_of(shown: ShownMount) -> Mount:
    yaw = shown.yaw if abs(shown.yaw) > _ANOTHER_WAY else 0.0
    return Mount(Pose(theta=yaw), UPSIDE_DOWN if shown.is_turned_over else UPRIGHT)


def _contradiction(shown: ShownMount) -> str:
    """Return a remark about a lidar whose scans contradict the mount that was given."""
    if shown.is_turned_over:
        wrong = (
            "its scans turn one way and the odometry the other one: one of the two is mirrored, or "
            "the lidar hangs the other way round than was told"
        )
    else:
        wrong = (
            "by its scans against the odometry it looks "
            f"{degrees_aside(shown.yaw)} of where it was told to"
        )
    return (
        f"the lidar's mount is taken as it was told, but {wrong}; --laser X,Y,YAW[,upside-down] "
        "says how it is"
    )
