"""CARMEN logs as drives are read from: what their lines tell, when, and where the laser is."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from roomba.arrays import Floats32, Mask
from roomba.geometry import Pose, wrap_angle
from roomba.perception.matching.mounts import FrameTransform
from roomba.perception.matching.plausible import FARTHEST_ECHO, scan_fault
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.carmen.lines import CarmenLine, Fan
from roomba.recordings.carmen.text import MOUNT_PARAMETERS, CarmenText
from roomba.recordings.log import Arrival, Channel, Frames, MountOf
from roomba.recordings.readings import UNUSABLE_SCANS, Kind, LidarScan, Odometry, Refused, Value
from roomba.recordings.times.set_back import gone_on
from roomba.recordings.times.untimed import spread_times, tell_nothing

BASE: Final = "base_link"
_ECHO: Final = 0.998
"""Share of a log's largest range; a beam that is as long or longer met nothing. Lidars say so by
their largest numbers, of which a SICK has several."""
_NEAREST: Final = 0.02
"""m; 0 is another way to say that nothing was met."""
_SAME_PLACE, _SAME_TURN = 0.005, 0.005
"""m, rad; if the laser's pose on the robot varies by less, that is where it is mounted."""


class CarmenLog:
    """A log that is held in memory."""

    def __init__(self, path: Path) -> None:
        """Read all of it; raises LogError."""
        self.path = path
        text = CarmenText(path)
        self.notes, self._lines = text.notes, text.lines
        self._parameters, self._other = text.parameters, text.other
        self._is_by_order = False
        self._go_on()
        self._tell_apart()
        largest = max((_largest(line.ranges) for line in self._lines), default=0.0)
        self._farthest = _ECHO * largest
        self.channels = self._count()

    def frames(self, odometry: Channel) -> Frames:
        """Return the name of the body's frame: a log has none of its own."""
        return Frames("", BASE)

    def transforms(self) -> Iterable[FrameTransform]:
        """Return where the lasers are: by the poses in the log if they tell, or its parameters."""
        for channel in self.channels:
            if channel.kind is Kind.SCAN:
                mount = self._mount_by_poses(channel.name) or self._mount_by_parameters()
                half = 0.5 * mount.theta
                turn = (0.0, 0.0, math.sin(half), math.cos(half))
                yield FrameTransform.of(BASE, channel.name, (mount.x, mount.y, 0.0), turn)

    def entries(self, channels: Sequence[Channel]) -> Iterator[Arrival]:
        """Yield what came on channels."""
        for line in self._lines:
            for number, channel in enumerate(channels):
                if _tells(line, channel):
                    yield Arrival(number, line.stamp, line.arrival, self._is_by_order)

    def values(
        self, channels: Sequence[Channel], wanted: Mask, mount_of: MountOf
    ) -> Iterator[Value | Refused | None]:
        """Yield the values of channels."""
        lidars: dict[tuple[str, Fan], LidarModel] = {}
        at = 0
        for line in self._lines:
            for channel in channels:
                if _tells(line, channel):
                    at += 1
                    yield self._value(line, channel, lidars, mount_of) if wanted[at - 1] else None

    def close(self) -> None:
        """Do nothing: the file was closed when it was read."""

    def _value(
        self,
        line: CarmenLine,
        channel: Channel,
        lidars: dict[tuple[str, Fan], LidarModel],
        mount_of: MountOf,
    ) -> Value | Refused:
        if channel.kind is Kind.ODOMETRY and line.odometry is not None:
            return Odometry(line.odometry)
        if line.fan is None or line.ranges is None:
            return Refused(UNUSABLE_SCANS, "it has no beams")
        fan, key = line.fan, (line.word, line.fan)
        fault = scan_fault(line.ranges, fan.first, fan.step, _NEAREST, fan.farthest or math.inf)
        if fault:
            return Refused(UNUSABLE_SCANS, fault)
        if key not in lidars:
            angles = fan.first + fan.step * np.arange(fan.beams)
            farthest = min(fan.farthest or math.inf, self._farthest)
            mount = mount_of(channel.name, Kind.SCAN)
            angles = -angles if mount.is_upside_down else angles
            lidars[key] = LidarModel(angles, _NEAREST, max(farthest, 2 * _NEAREST), mount.pose)
        return LidarScan(line.ranges, lidars[key])

    def _go_on(self) -> None:
        """Let times go on where the clock was set back, as between two drives in a file."""
        arrivals = np.array([line.arrival for line in self._lines])
        if tell_nothing(arrivals):
            # Some writers have the stamp alone.
            arrivals = np.array([line.stamp for line in self._lines])
        went_on = gone_on(arrivals, [line.word for line in self._lines])
        if np.array_equal(went_on, arrivals):
            return
        self._lines = [
            line._replace(arrival=arrival)
            for line, arrival in zip(self._lines, went_on.tolist(), strict=True)
        ]
        self.notes.append("the recorder's clock was set back on the way: the time goes on there")

    def _tell_apart(self) -> None:
        """Give lines times by their order if those of the scans are nearly all the same."""
        is_scan = np.array([line.fan is not None for line in self._lines])
        stamps = np.array([line.stamp for line in self._lines])
        arrivals = np.array([line.arrival for line in self._lines])
        if not (tell_nothing(stamps[is_scan]) and tell_nothing(arrivals[is_scan])):
            return
        self._is_by_order = bool((arrivals > 0.0).any())
        times = spread_times(arrivals, is_scan).tolist()
        self._lines = [
            line._replace(stamp=0.0, arrival=time)
            for line, time in zip(self._lines, times, strict=True)
        ]
        self.notes.append(
            f"the times in {self.path.name} do not tell its scans apart: they go by their order"
        )

    def _count(self) -> list[Channel]:
        counts = Counter(line.word for line in self._lines)
        channels = []
        for word, count in counts.items():
            has_odometry = any(line.odometry for line in self._lines if line.word == word)
            if word != "ODOM":
                channels.append(Channel(word, Kind.SCAN, "scans", count))
            if has_odometry:
                channels.append(Channel(word, Kind.ODOMETRY, "odometry", count))
        others = (Channel(word, None, "other lines", n) for word, n in self._other.items())
        # Odometry that comes with the scans is listed first: it tells the place of each scan
        # itself.
        return [*sorted(channels, key=lambda each: each.name == "ODOM"), *others]

    def _mount_by_poses(self, word: str) -> Pose | None:
        """Return where the laser is by the poses of scans; None if it is at 0, or varies."""
        mounts = [
            line.odometry.inverse().compose(line.laser)
            for line in self._lines
            if line.word == word and line.odometry is not None and line.laser is not None
        ]
        if not mounts:
            return None
        rows = np.array([(each.x, each.y, each.theta) for each in mounts])
        middle = Pose(*np.median(rows, axis=0).tolist())
        away = np.hypot(rows[:, 0] - middle.x, rows[:, 1] - middle.y).max()
        turned = max(abs(wrap_angle(theta - middle.theta)) for theta in rows[:, 2].tolist())
        is_same = math.hypot(middle.x, middle.y) < _SAME_PLACE and abs(middle.theta) < _SAME_TURN
        if is_same or away > _SAME_PLACE or turned > _SAME_TURN:
            return None
        return middle

    def _mount_by_parameters(self) -> Pose:
        return Pose(*(self._parameters.get(name, 0.0) for name in MOUNT_PARAMETERS))


def _tells(line: CarmenLine, channel: Channel) -> bool:
    if line.word != channel.name:
        return False
    return line.odometry is not None if channel.kind is Kind.ODOMETRY else line.fan is not None


def _largest(ranges: Floats32 | None) -> float:
    """Return the largest range that a lidar may measure, m; 0 of none."""
    if ranges is None:
        return 0.0
    return float(ranges.max(initial=0.0, where=ranges <= FARTHEST_ECHO))
