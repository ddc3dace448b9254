"""CARMEN logs: a line of text for each reading, as of most of the older published drives.

What is read of a line, of those that a drive needs; three words at its end are when it was
measured, by which computer, and when it was recorded, s::

    ODOM x y theta tv rv accel
    FLASER readings [range ...] laser_x laser_y laser_theta odom_x odom_y odom_theta
    ROBOTLASER1 type start_angle field_of_view step farthest accuracy remission_mode readings
        [range ...] remissions [remission ...] laser_x laser_y laser_theta odom_x odom_y odom_theta
        tv rv forward_safety_distance side_safety_distance turn_axis
    RAWLASER1 type start_angle field_of_view step farthest accuracy remission_mode readings
        [range ...] remissions [remission ...]
    PARAM name value

Lengths in m, angles in rad. A FLASER looks ahead over 180 degrees, from right to left; with 400
beams or so over 100 degrees, as its maker sells it.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.perception.matching.mounts import FrameTransform
from roomba.perception.matching.plausible import FARTHEST_ECHO, scan_fault
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.log import Arrival, Channel, Frames, MountOf
from roomba.recordings.packed import Unpacked
from roomba.recordings.readings import (
    UNUSABLE_SCANS,
    Kind,
    LidarScan,
    LogError,
    Odometry,
    Refused,
    Value,
)
from roomba.recordings.times.stamps import gone_on
from roomba.recordings.times.untimed import spread_times, tell_nothing

BASE: Final = "base_link"
WORDS: Final = ("FLASER", "ROBOTLASER1", "RAWLASER1", "ODOM", "PARAM")
"""Lines that are read."""
_LISTED: Final = 10
"""First words of a file that is no log, in its refusal."""
_LONGEST: Final = 30
"""Characters of each."""
_LONGEST_REASON: Final = 80
"""Characters of why a line cannot be read."""
_NARROW: Final = (400, 401)
"""Readings of a FLASER over 100 degrees."""
_ECHO: Final = 0.998
"""What is as far as this share of the largest range of a log met nothing: lidars say so by their
largest numbers, of which a SICK has several.
"""
_NEAREST: Final = 0.02
"""m; 0 is another way to say that nothing was met."""
_SAME_PLACE, _SAME_TURN = 0.005, 0.005
"""m, rad; poses of the laser and the robot that are so constant tell where it is mounted."""
_MOUNT_PARAMETERS: Final = (
    "robot_frontlaser_offset",
    "robot_frontlaser_side_offset",
    "robot_frontlaser_angular_offset",
)


class _Fan(NamedTuple):
    """Beams: the first one's angle and the step to the next, rad, and what is the farthest, m."""

    beams: int
    first: float
    step: float
    farthest: float


class _Line(NamedTuple):
    """One line: ``word`` says of which kind; without an odometry or a scan those are None."""

    word: str
    stamp: float
    arrival: float
    odometry: Pose | None
    laser: Pose | None
    fan: _Fan | None
    ranges: NDArray[np.float32] | None


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else f"{text[:longest]}…"


def _shown(words: Iterable[str]) -> str:
    """Return the first words, each cut: a file of another kind may be one long word, or many."""
    shown = [_cut(word, _LONGEST) for word in words]
    return ", ".join(shown[:_LISTED]) + (", …" if len(shown) > _LISTED else "")


class CarmenLog:
    """A log that is held in memory."""

    def __init__(self, path: Path) -> None:
        """Read all of it; raises LogError."""
        self.path = path
        self.notes: list[str] = []
        self._parameters: dict[str, float] = {}
        self._broken = 0
        self._first_broken = ""
        self._other: Counter[str] = Counter()
        self._lines = self._read(path)
        if self._broken:
            self.notes.append(
                f"{self._broken} lines of {path.name} cannot be read: left out (the first: "
                f"{self._first_broken})"
            )
        if not self._lines:
            self._refuse_numbers(path)
            there = self.notes or [f"it has {_shown(self._other) or 'nothing'}"]
            raise LogError(
                f"{path}: expected lines {', '.join(WORDS[:-1])} of a CARMEN log, got none; "
                f"{'; '.join(there)}"
            )
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
        self, channels: Sequence[Channel], wanted: NDArray[np.bool_], mount_of: MountOf
    ) -> Iterator[Value | Refused | None]:
        """Yield the values of channels."""
        lidars: dict[tuple[str, _Fan], LidarModel] = {}
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
        line: _Line,
        channel: Channel,
        lidars: dict[tuple[str, _Fan], LidarModel],
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

    def _read(self, path: Path) -> list[_Line]:
        file = Unpacked(path)
        try:
            with file.path.open(encoding="utf-8", errors="replace") as text:
                lines = (self._parse(number, each.split()) for number, each in enumerate(text, 1))
                return [line for line in lines if line is not None]
        finally:
            file.close()

    def _parse(self, number: int, words: list[str]) -> _Line | None:
        if not words or words[0].startswith("#"):
            return None
        word = words[0]
        parse = _PARSERS.get(word)
        if parse is None and word != "PARAM":
            self._other[word] += 1
            return None
        try:
            if parse is not None:
                return parse(words)
            if words[1] in _MOUNT_PARAMETERS:
                self._parameters[words[1]] = _finite(words[2])
        except IndexError:
            self._note_broken(number, word, f"it has {len(words)} words only")
        except ValueError as error:
            self._note_broken(number, word, str(error))
        return None

    def _note_broken(self, number: int, word: str, reason: str) -> None:
        self._broken += 1
        if not self._first_broken:
            self._first_broken = f"line {number}, {word}: {_cut(reason, _LONGEST_REASON)}"

    def _refuse_numbers(self, path: Path) -> None:
        """Refuse a text most of whose lines begin with a number; raises LogError."""
        numbers = [word for word in self._other if is_number(word)]
        if 2 * sum(self._other[word] for word in numbers) > self._other.total():
            raise LogError(
                f"{path}: expected lines {', '.join(WORDS[:-1])} of a CARMEN log, got lines that "
                f"begin with numbers, as {_cut(numbers[0], _LONGEST)}: a line of a CARMEN log "
                "begins with what it tells, as `FLASER 3 1.5 1.6 1.4 0 0 0 0 0 0 12.5 host 12.5`, "
                "of three ranges, two poses and its time"
            )

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
        # By the odometry that scans bring along each one's own place is known.
        return [*sorted(channels, key=lambda each: each.name == "ODOM"), *others]

    def _mount_by_poses(self, word: str) -> Pose | None:
        """Return where the laser is by the poses of scans; None if they are equal or differ."""
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
        return Pose(*(self._parameters.get(name, 0.0) for name in _MOUNT_PARAMETERS))


def _tells(line: _Line, channel: Channel) -> bool:
    if line.word != channel.name:
        return False
    return line.odometry is not None if channel.kind is Kind.ODOMETRY else line.fan is not None


def _parse_odometry(words: list[str]) -> _Line:
    stamp, arrival = _times(words[7:])
    return _Line("ODOM", stamp, arrival, _pose(words[1:4]), None, None, None)


def _parse_front_laser(words: list[str]) -> _Line:
    beams = int(words[1])
    ranges, rest = _ranges(words[2 : 2 + beams], beams), words[2 + beams :]
    if beams in _NARROW:
        fan = _Fan(beams, -math.radians(50.0), math.radians(0.25), 0.0)
    else:
        step = math.pi / max(beams - beams % 2, 1)
        fan = _Fan(beams, -0.5 * math.pi, step, 0.0)
    stamp, arrival = _times(rest[6:])
    return _Line("FLASER", stamp, arrival, _pose(rest[3:6]), _pose(rest[:3]), fan, ranges)


def _parse_robot_laser(words: list[str]) -> _Line:
    fan, ranges, rest = _configured(words)
    laser, odometry = _pose(rest[:3]), _pose(rest[3:6])
    stamp, arrival = _times(rest[11:])
    return _Line("ROBOTLASER1", stamp, arrival, odometry, laser, fan, ranges)


def _parse_raw_laser(words: list[str]) -> _Line:
    fan, ranges, rest = _configured(words)
    stamp, arrival = _times(rest)
    return _Line("RAWLASER1", stamp, arrival, None, None, fan, ranges)


_PARSERS: Final = {
    "ODOM": _parse_odometry,
    "FLASER": _parse_front_laser,
    "ROBOTLASER1": _parse_robot_laser,
    "RAWLASER1": _parse_raw_laser,
}


def _configured(words: list[str]) -> tuple[_Fan, NDArray[np.float32], list[str]]:
    """Return beams and ranges of a line that tells its lidar, and the words after them."""
    first, step, farthest = _finite(words[2]), _finite(words[4]), _finite(words[5])
    beams = int(words[8])
    ranges = _ranges(words[9 : 9 + beams], beams)
    remissions = int(words[9 + beams])
    return _Fan(beams, first, step, farthest), ranges, words[10 + beams + remissions :]


def _ranges(words: list[str], beams: int) -> NDArray[np.float32]:
    if len(words) != beams or beams < 0:
        raise ValueError(f"expected {beams} ranges, got {len(words)}")
    return np.array(words, np.float64).astype(np.float32)


def _pose(words: list[str]) -> Pose:
    if len(words) < 3:
        raise ValueError(f"expected x, y and theta, got {len(words)} numbers")
    x, y, theta = map(_finite, words)
    return Pose(x, y, wrap_angle(theta))


def _times(words: list[str]) -> tuple[float, float]:
    """Return stamp and arrival, s, of the words that end a line: 0 for a stamp that is missing."""
    stamp = _finite(words[0]) if words else 0.0
    return stamp, _finite(words[2]) if len(words) > 2 else stamp


def is_number(word: str) -> bool:
    """Whether a word is that of a number, nan and infinity included."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def _finite(word: str) -> float:
    number = float(word)
    if not math.isfinite(number):
        raise ValueError(f"expected a finite number, got {word}")
    return number


def _largest(ranges: NDArray[np.float32] | None) -> float:
    """Return the largest range that a lidar may measure, m; 0 of none."""
    if ranges is None:
        return 0.0
    return float(ranges.max(initial=0.0, where=ranges <= FARTHEST_ECHO))
