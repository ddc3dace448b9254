"""Which channels of a recorded drive are read: those that were named, else what is likely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.geometry import Pose
from roomba.recordings.log import Channel
from roomba.recordings.readings import Kind, LogError

_LISTED: Final = 30
"""Channels that an error names at most."""
_USUAL: Final = {Kind.SCAN: "/scan", Kind.ODOMETRY: "/odom", Kind.GYRO: "/imu"}
_TYPES: Final = {
    Kind.SCAN: "sensor_msgs/LaserScan",
    Kind.ODOMETRY: "nav_msgs/Odometry",
    Kind.GYRO: "sensor_msgs/Imu",
}
_CLOUDS: Final = "sensor_msgs/PointCloud2"
"""What lidars tell as well; only scans are read."""
_WORDS: Final = {
    Kind.SCAN: "scans of a lidar",
    Kind.ODOMETRY: "odometry",
    Kind.GYRO: "readings of a gyro",
}
"""What a text has in place of messages of these types."""
_BESIDE: Final = {
    Kind.LIFTED: ("wheel_drop",),
    Kind.TOLD: ("initialpose", "amcl_pose"),
    Kind.OWN_POSE: ("pose", "position", "amcl_pose"),
}
"""Names of what may be beside scans and odometry, the likelier ones first."""
_OPTIONS: Final = {Kind.SCAN: "--scan", Kind.ODOMETRY: "--odom", Kind.GYRO: "--imu"}


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be read: names of channels, and where the lidar is on the robot; None: find out.

    ``laser_is_upside_down`` says how it hangs where ``laser`` says where; None: as recorded.
    ``beside`` are the kinds that are read, too, where they are there.
    """

    scan: str | None = None
    odometry: str | None = None
    gyro: str | None = None
    laser: Pose | None = None
    laser_is_upside_down: bool | None = None
    beside: frozenset[Kind] = frozenset({Kind.TRUTH, Kind.LIFTED})

    def name(self, kind: Kind) -> str | None:
        """Return the name that was given for a kind."""
        names = {Kind.SCAN: self.scan, Kind.ODOMETRY: self.odometry, Kind.GYRO: self.gyro}
        return names.get(kind)


@dataclass(frozen=True, slots=True)
class Chosen:
    """The channels that are read, scans first; ``notes`` tells of doubts."""

    channels: tuple[Channel, ...]
    notes: tuple[str, ...]

    @property
    def has_odometry(self) -> bool:
        """Whether one of them is of odometry."""
        return any(channel.kind is Kind.ODOMETRY for channel in self.channels)

    def without(self, kind: Kind) -> Chosen:
        """Return the same without a channel of a kind."""
        kept = (channel for channel in self.channels if channel.kind is not kind)
        return Chosen(tuple(kept), self.notes)

    def name(self, kind: Kind) -> str | None:
        """Return the name of the channel of a kind; None if there is none."""
        return next((channel.name for channel in self.channels if channel.kind is kind), None)


def chosen(paths: Sequence[Path], channels: Sequence[Channel], wanted: Wanted) -> Chosen:
    """Return what to read of the ``channels`` of all logs; raises LogError."""
    notes: list[str] = []
    scan = _required(paths, channels, Kind.SCAN, wanted, "", notes)
    motion = _odometry_and_gyro(paths, channels, wanted, scan, notes)
    robot = motion[0] if motion else scan
    beside = [
        channel
        for kind in sorted(wanted.beside)
        for channel in _usual(channels, kind, robot.name, _BESIDE.get(kind, ()))
    ]
    if Kind.TRUTH in wanted.beside:
        beside += [channel for channel in channels if channel.kind is Kind.TRUTH][:1]
    return Chosen((scan, *motion, *beside), tuple(notes))


def _odometry_and_gyro(
    paths: Sequence[Path],
    channels: Sequence[Channel],
    wanted: Wanted,
    scan: Channel,
    notes: list[str],
) -> list[Channel]:
    """Return odometry and gyro of the robot that has the scan; [] if there is no odometry."""
    is_missing = not any(channel.kind is Kind.ODOMETRY for channel in channels)
    if is_missing and wanted.odometry is None:
        notes.append("no odometry was recorded: it goes by scans alone")
        return []
    odometry = _required(paths, channels, Kind.ODOMETRY, wanted, scan.name, notes)
    return [odometry, *_gyro(paths, channels, wanted, odometry.name, notes)]


def _required(
    paths: Sequence[Path],
    channels: Sequence[Channel],
    kind: Kind,
    wanted: Wanted,
    beside: str,
    notes: list[str],
) -> Channel:
    """Return a channel of a kind; of several the one whose name is most like ``beside``."""
    fitting = [channel for channel in channels if channel.kind is kind]
    named = wanted.name(kind)
    if named is not None or not fitting:
        return _named(paths, channels, kind, named or _USUAL[kind])
    best = max(fitting, key=lambda channel: _likeness(channel, beside, _USUAL[kind]))
    others = [f"{each.name} ({each.messages})" for each in fitting if each is not best]
    if others:
        notes.append(
            f"{_OPTIONS[kind]} {best.name} ({best.messages}) is taken; there is "
            f"{' and '.join(others)} as well"
        )
    return best


def _gyro(
    paths: Sequence[Path],
    channels: Sequence[Channel],
    wanted: Wanted,
    odometry: str,
    notes: list[str],
) -> list[Channel]:
    """Return the gyro's channel; if none was named, only one with a usual name is taken.

    A gyro with another name may be a camera's, and measure about an axis that is not the vertical.
    """
    if wanted.gyro is not None:
        return [_named(paths, channels, Kind.GYRO, wanted.gyro)]
    usual = _usual(channels, Kind.GYRO, odometry, ("imu", "imu/data"))
    if usual:
        return usual
    fitting = [channel for channel in channels if channel.kind is Kind.GYRO]
    if fitting:
        names = " or ".join(channel.name for channel in fitting)
        notes.append(f"no gyro is used: --imu {names} would be, if it lies flat on the robot")
    return []


def _usual(
    channels: Sequence[Channel], kind: Kind, odometry: str, names: Sequence[str]
) -> list[Channel]:
    """Return the channel of a kind with the first of names, best that of the odometry's robot."""
    namespace = odometry.rpartition("/")[0]
    for name in names:
        for spelled in (f"{namespace}/{name}", f"/{name}"):
            for channel in channels:
                if channel.kind is kind and channel.name == spelled:
                    return [channel]
    return []


def _named(paths: Sequence[Path], channels: Sequence[Channel], kind: Kind, name: str) -> Channel:
    """Return the channel of a name; raises LogError if there is none of this kind."""
    spellings = (name, f"/{name.strip('/')}")
    for channel in channels:
        if channel.kind is kind and channel.name in spellings:
            return channel
    there = [channel for channel in channels if channel.name in spellings]
    got = f"it is {there[0].type}" if there else "there is none"
    option = _OPTIONS[kind]
    fitting = " or ".join(f"{option} {each.name}" for each in channels if each.kind is kind)
    is_topic = all(each.name.startswith("/") for each in channels)
    if is_topic:
        sought = f"{_TYPES[kind]} on {spellings[-1]}"
        hint = f"try {fitting}" if fitting else f"no other one is {_TYPES[kind]} either"
        if kind is Kind.SCAN and not fitting:
            hint += _clouds_instead(channels)
    else:
        sought = _WORDS[kind] if name == _USUAL[kind] else f"{_WORDS[kind]} in lines {name}"
        hint = f"try {fitting}" if fitting else "no lines tell any"
    raise LogError(
        f"{', '.join(map(str, paths))}: expected {sought}, {got}; {hint}. There is "
        f"{_listed(channels)}"
    )


def _clouds_instead(channels: Sequence[Channel]) -> str:
    """Return what to do with clouds of points where no channel has scans; "" without clouds."""
    clouds = [each.name for each in channels if each.type == _CLOUDS]
    if not clouds:
        return ""
    return (
        f". What a lidar may have told on {' and '.join(clouds)} ({_CLOUDS}) is not read: make "
        "scans of it, as pointcloud_to_laserscan does while the bag is played, and record them "
        "with all else"
    )


def _listed(channels: Sequence[Channel]) -> str:
    # A topic that tells two kinds is listed once.
    told = (f"{each.name} ({each.type}, {each.messages})" for each in channels)
    names = list(dict.fromkeys(told))
    if len(names) > _LISTED:
        names = [*names[:_LISTED], f"and {len(names) - _LISTED} more"]
    return ", ".join(names)


def _likeness(channel: Channel, beside: str, usual: str) -> tuple[bool, bool, bool, int]:
    """Return how likely a channel is the one: by names ``beside`` and ``usual``, and size."""
    name = channel.name
    is_same_robot = bool(beside) and name.rpartition("/")[0] == beside.rpartition("/")[0]
    return name == beside, is_same_robot, name.endswith(usual), channel.messages
