"""A recorded drive: any number of logs, read as one, in the order of time."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from roomba.arrays import Floats, Ints64, Mask
from roomba.perception.matching.mounts import Mount
from roomba.recordings.drives.choice import Chosen, Wanted, chosen
from roomba.recordings.drives.filled import filled
from roomba.recordings.drives.fixed_beams import UnhiddenScans
from roomba.recordings.drives.mounting import BODIES, Mounting
from roomba.recordings.drives.opening import open_log
from roomba.recordings.drives.sweeps import Sweep, SweptScans
from roomba.recordings.log import Channel, Frames, Log
from roomba.recordings.readings import (
    UNUSABLE_SCANS,
    Kind,
    LidarScan,
    LogError,
    Reading,
    Refused,
    Value,
)
from roomba.recordings.times.clock_rate import drift_of, drift_of_played, drift_of_recorder, unit_of
from roomba.recordings.times.stamps import (
    StampCounts,
    delay_of,
    in_order,
    is_of_another_clock,
    mended,
)
from roomba.recordings.times.untimed import times_by_order

_DRIFTED: Final = 0.1
"""s; if a channel's delay grows by more than this beside the odometry's, its clock is off."""
_GAP: Final = 1.0
"""s between two logs from which it is told."""
_ODOMETRY: Final = "odom"


class LoggedDrive:
    """Logs that are open for reading; a context.

    All messages are looked at twice: first for their times alone, of which some thirty bytes each
    are kept, then in the order of these times.
    """

    def __init__(self, paths: Sequence[Path], wanted: Wanted | None = None) -> None:
        """Open; raises LogError."""
        wanted = wanted or Wanted()
        self.keeps_odometry = wanted.odometry is not None
        """Whether odometry was named, which then is not given up for scans alone."""
        self.keeps_gyro = wanted.gyro is not None
        """Whether a gyro was named, which counts even if it is doubtful."""
        self.counts = StampCounts()
        self.refused: Counter[str] = Counter()
        """How many messages could not be used, by what they are."""
        self._reasons: dict[str, str] = {}
        self._remarks: list[str] = []
        self._sweep: Sweep | None = None
        self._unhidden: UnhiddenScans | None = None
        with contextlib.ExitStack() as stack:
            self._logs = [_entered(stack, path) for path in paths]
            channels = _together(self._logs)
            self.names = frozenset(channel.name for channel in channels)
            """The names of all channels, also of those that are not read."""
            self._chosen = self._chosen_of(paths, channels, wanted)
            self._frames = self._told_frames()
            self._mounting = Mounting(self._logs, self._frames.body, wanted)
            self._times, self._arrivals, self._owners, self._order = self._timed()
            self._stack = stack.pop_all()

    def _chosen_of(
        self, paths: Sequence[Path], channels: Sequence[Channel], wanted: Wanted
    ) -> Chosen:
        """Return what to read; raises LogError, which tells as well what could not be read."""
        try:
            return chosen(paths, channels, wanted)
        except LogError as error:
            notes = [note for log in self._logs for note in log.notes]
            raise LogError("; ".join([str(error), *notes])) from None

    def __enter__(self) -> LoggedDrive:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close all logs."""
        self._stack.close()

    @property
    def chosen(self) -> Chosen:
        """The channels that are read."""
        return self._chosen

    @property
    def odometry_frame(self) -> str:
        """The frame in which odometry tells poses."""
        return self._frames.odometry

    @property
    def body_frame(self) -> str:
        """The frame of the robot's body."""
        return self._frames.body

    @property
    def notes(self) -> list[str]:
        """What is worth knowing of what was read so far."""
        left_out = [
            f"{count} {what}: left out (the first: {self._reasons[what]})"
            for what, count in self.refused.items()
        ]
        of_logs = [note for log in self._logs for note in log.notes]
        own = [*self._remarks, *self._mounting.notes]
        return [*self._chosen.notes, *own, *of_logs, *left_out]

    def reason_of(self, what: str) -> str:
        """Return why the first one of what was refused could not be used; "" of none."""
        return self._reasons.get(what, "")

    @property
    def is_mount_told(self) -> bool:
        """Whether ``--laser`` or a recorded transform told where each lidar is that was read."""
        return self._mounting.is_told

    def take_mount(self, shown: Mount) -> None:
        """Read scans from now on as of a lidar mounted as ``shown``, where nothing tells."""
        self._mounting.take(shown)

    def leave_odometry(self, reason: str) -> None:
        """Read no odometry from now on, and tell why."""
        self.remark(f"the odometry is not used, it goes by scans alone: {reason}")
        self._leave(Kind.ODOMETRY)

    def leave_gyro(self, reason: str) -> None:
        """Read no gyro from now on, and tell why."""
        self.remark(
            f"the gyro is not used: {reason}; --imu {self._chosen.name(Kind.GYRO)} uses it all the "
            "same"
        )
        self._leave(Kind.GYRO)

    def _leave(self, kind: Kind) -> None:
        """Read no channel of a kind from now on."""
        self._chosen = self._chosen.without(kind)
        self.counts = StampCounts()
        self._times, self._arrivals, self._owners, self._order = self._timed()

    def take_sweep(self, sweep: Sweep) -> None:
        """Read all scans from now on by ``sweep`` instead of the times that the driver tells."""
        self._sweep = sweep

    def leave_beams(self, fixed: Mask) -> None:
        """Leave out ``fixed`` beams, [beams], and no others, from now on: a thing hides them."""
        self._unhidden = UnhiddenScans(fixed)

    def remark(self, remark: str) -> None:
        """Add a note."""
        self._remarks.append(remark)

    @property
    def refused_scans(self) -> dict[str, int]:
        """How many scans could not be used, by the first reason."""
        return {
            f"{what} ({self._reasons[what]})": count
            for what, count in self.refused.items()
            if what == UNUSABLE_SCANS
        }

    def __len__(self) -> int:
        """How many readings were recorded: some may be refused, and odometry be added."""
        return len(self._order)

    def readings(self) -> Iterator[Reading]:
        """Yield what was measured, in the order of time; at equal times odometry before scans.

        Where odometry is rarer than scans, more of it is added: see :func:`filled`.
        """
        return filled(self._measured())

    def _measured(self) -> Iterator[Reading]:
        self.refused.clear()
        swept = None if self._sweep is None else SweptScans(self._sweep)
        wanted = np.zeros(len(self._times), np.bool_)
        wanted[self._order] = True
        first = np.searchsorted(self._owners, np.arange(len(self._logs) + 1))
        streams = [
            log.values(self._channels_of(log), wanted[begin:end], self._mounting.of)
            for log, (begin, end) in zip(self._logs, pairwise(first.tolist()), strict=True)
        ]
        positions = first[:-1].tolist()
        held: dict[int, Value | Refused] = {}
        for number in self._order.tolist():
            owner = int(self._owners[number])
            while positions[owner] <= number:
                value = next(streams[owner])
                if value is not None:
                    held[positions[owner]] = value
                positions[owner] += 1
            reading = held.pop(number)
            if isinstance(reading, Refused):
                self.refused[reading.what] += 1
                self._reasons.setdefault(reading.what, reading.reason)
            else:
                if self._unhidden is not None and isinstance(reading, LidarScan):
                    reading = self._unhidden.of(reading)
                if swept is not None and isinstance(reading, LidarScan):
                    reading = swept.of(reading)
                times = (self._times[number], self._arrivals[number])
                yield Reading(float(times[0]), reading, float(times[1]))

    def _channels_of(self, log: Log) -> list[Channel]:
        """Return the chosen channels that a log has."""
        return [
            own
            for channel in self._chosen.channels
            for own in log.channels
            if (own.name, own.kind) == (channel.name, channel.kind)
        ]

    def _told_frames(self) -> Frames:
        """Return the frames of odometry and of the robot's body."""
        told = [
            log.frames(each)
            for log in self._logs
            for each in self._channels_of(log)
            if each.kind is Kind.ODOMETRY
        ]
        worlds = (each.odometry for each in told if each.odometry)
        bodies = (each.body for each in told if each.body)
        return Frames(next(worlds, _ODOMETRY), next(bodies, BODIES[0]))

    def _timed(self) -> tuple[Floats, Floats, Ints64, Ints64]:
        """Return all messages' times and arrivals, s, the numbers of their logs, their order."""
        parts = [self._timed_log(log) for log in self._logs]
        sizes = [len(times) for times, *_ in parts]
        times, arrivals = (np.concatenate([part[at] for part in parts]) for at in (0, 1))
        channels = np.concatenate([numbers for *_, numbers in parts])
        owners = np.repeat(np.arange(len(parts)), sizes)
        self._tell_gaps([times for times, *_ in parts])
        ranks = np.array([int(each.kind or 0) for each in self._chosen.channels])[channels]
        return times, arrivals, owners, in_order(times, channels, ranks, self.counts)

    def _timed_log(self, log: Log) -> tuple[Floats, Floats, Ints64]:
        """Return times, arrivals and numbers of channels, among the chosen ones, of a log."""
        channels = self._channels_of(log)
        entries = list(log.entries(channels))
        own = np.array([entry.channel for entry in entries], np.int64)
        stamps = np.array([entry.stamp for entry in entries], np.float64)
        recorded = np.array([entry.arrival for entry in entries], np.float64)
        arrivals = recorded.copy()
        is_by_order = np.array([entry.is_by_order for entry in entries], np.bool_)
        for mask in self._not_told_apart(channels, own, stamps, arrivals):
            is_by_order[mask] = True
        for at, channel in enumerate(channels):
            self._take_units(channel, own == at, stamps, arrivals)
        self._follow_odometry(channels, own, stamps, arrivals)
        self._even_rates(channels, own, stamps, arrivals)
        delays = [delay_of(stamps[own == at], arrivals[own == at]) for at in range(len(channels))]
        reference = self._reference(channels, delays)
        times = np.empty(len(entries))
        numbers = np.empty(len(entries), np.int64)
        for at, channel in enumerate(channels):
            mask, delay = own == at, delays[at]
            if is_by_order[mask].any():
                times[mask] = arrivals[mask] - reference
                self.counts.add(StampCounts(len(times[mask]), by_order=len(times[mask])))
            else:
                times[mask] = mended(stamps[mask], arrivals[mask], reference, self.counts)
            numbers[mask] = self._number(channel)
            if delay is not None and is_of_another_clock(delay, reference):
                self._remarks.append(
                    f"the clock of {channel.name} is {reference - delay:+.1f} s off that of the "
                    "odometry: its times are shifted"
                )
        return times, recorded, numbers

    def _take_units(self, channel: Channel, mask: Mask, stamps: Floats, arrivals: Floats) -> None:
        """Convert the stamps of a channel to seconds, in place, if they are in another unit."""
        unit, name = unit_of(stamps[mask], arrivals[mask])
        if unit != 1.0:
            stamps[mask] /= unit
            self._remarks.append(f"the stamps of {channel.name} are in {name}: taken so")

    def _follow_odometry(
        self, channels: Sequence[Channel], own: Ints64, stamps: Floats, arrivals: Floats
    ) -> None:
        """Let ``arrivals``, in place, go on as the stamps of the odometry do.

        The clock of the recorder may go at another rate than that of the robot, as where a drive
        was recorded while it was played, or simulated, faster or slower than in real time.
        """
        pairs = [(stamps[own == at], arrivals[own == at]) for at in range(len(channels))]
        drift = self._reference(channels, [drift_of(*pair) for pair in pairs])
        played = [drift_of_played(*pair) for pair in pairs]
        drift = drift or drift_of_recorder(self._reference(channels, played), played)
        if drift:
            arrivals -= drift * (arrivals - arrivals.min())

    def _even_rates(
        self, channels: Sequence[Channel], own: Ints64, stamps: Floats, arrivals: Floats
    ) -> None:
        """Correct stamps, in place, of a clock that is fast or slow beside the arrivals.

        The arrivals go by the clock of the odometry already.
        """
        spent = float(np.ptp(arrivals)) if len(arrivals) else 0.0
        for at, channel in enumerate(channels):
            mask = own == at
            drift = drift_of(stamps[mask], arrivals[mask])
            if abs(drift) * spent < _DRIFTED:
                continue
            stamps[mask] += drift * (arrivals[mask] - arrivals.min())
            self._remarks.append(
                f"the clock of {channel.name} is {'slow' if drift > 0.0 else 'fast'} beside that "
                f"of the odometry, by {100.0 * abs(drift):.2g} %: its times are evened out"
            )

    def _not_told_apart(
        self, channels: Sequence[Channel], own: Ints64, stamps: Floats, arrivals: Floats
    ) -> Iterator[Mask]:
        """Yield masks of channels whose times are coarse; they get ``arrivals`` by their order."""
        for at, channel in enumerate(channels):
            mask = own == at
            spread = times_by_order(stamps[mask], arrivals[mask])
            if spread is not None:
                stamps[mask], arrivals[mask] = 0.0, spread
                self._remarks.append(
                    f"the times of {channel.name} do not tell its messages apart: they go by "
                    "their order, evenly between the times that differ"
                )
                yield mask

    def _number(self, channel: Channel) -> int:
        """Return the number of a log's channel among the chosen ones."""
        keys = [(each.name, each.kind) for each in self._chosen.channels]
        return keys.index((channel.name, channel.kind))

    def _reference(self, channels: Sequence[Channel], delays: Sequence[float | None]) -> float:
        """Return the delay of the odometry, or else the first one that is known, or else 0."""
        of_odometry = [
            delay
            for channel, delay in zip(channels, delays, strict=True)
            if channel.kind is Kind.ODOMETRY
        ]
        known = [delay for delay in (*of_odometry, *delays) if delay is not None]
        return known[0] if known else 0.0

    def _tell_gaps(self, times: Sequence[Floats]) -> None:
        """Note where logs overlap, and where time is missing between them."""
        spans = sorted(
            (float(each.min()), float(each.max()), log.path.name)
            for each, log in zip(times, self._logs, strict=True)
            if len(each)
        )
        for (_, end, name), (begin, _, later) in pairwise(spans):
            if begin > end + _GAP:
                self._remarks.append(f"{later} begins {begin - end:.1f} s after the end of {name}")
            elif begin < end:
                self._remarks.append(
                    f"{later} begins {end - begin:.1f} s before the end of {name}: what both have "
                    "counts once"
                )


def _entered(stack: contextlib.ExitStack, path: Path) -> Log:
    log = open_log(path)
    stack.callback(log.close)
    return log


def _together(logs: Sequence[Log]) -> list[Channel]:
    """Return the channels of all logs, each with its messages in all of them."""
    found: dict[tuple[str, Kind | None], Channel] = {}
    for log in logs:
        for channel in log.channels:
            known = found.get((channel.name, channel.kind))
            count = channel.messages + (0 if known is None else known.messages)
            found[channel.name, channel.kind] = channel._replace(messages=count)
    return list(found.values())
