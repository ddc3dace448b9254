"""A recorded run as a robot that a page observes: nothing is driven, and its time can be chosen."""

from __future__ import annotations

import threading
import time
from bisect import bisect_right
from typing import Any, Final

import numpy as np

from roomba.client import view
from roomba.client.observed import TimelineView
from roomba.client.plain import home_from
from roomba.client.protocol import (
    CleanReport,
    RequestRefusedError,
    VacuumSnapshot,
)
from roomba.geometry import Point, wrap_angle
from roomba.grid import GridFrame
from roomba.history.run import TRACE, RunFigures, RunRecording, Word, told
from roomba.history.run_file import RunFileError
from roomba.perception.swept.visits import Visits
from roomba.vocabulary import Hindrance

SPEEDS: Final = (0.25, 100.0)
"""The recording's seconds per second: the least and the most."""
_CARRIED: Final = 1.0
"""m between two rows; a robot that went farther was carried."""
_STEP: Final = 0.2
"""m between two places on the way from row to row."""
_END: Final = 0.02
"""s before the end that count as the end: times are told in hundredths."""


class RecordedRobot:
    """Plays a recording; its methods may be called from any thread. Commands are refused."""

    def __init__(self, figures: RunFigures, recording: RunRecording, speed: float = 10.0) -> None:
        """Begin at the first row, standing; raises RunFileError for an empty recording.

        It raises that, too, for a recording whose home cannot be shown.
        """
        if not len(recording.trace) or not recording.words:
            raise RunFileError("expected a recording with at least one row, got none")
        self._figures, self._recording = figures, recording
        self._home = _home_of(recording)
        self._times = recording.column("time").astype(np.float64)
        self._word_times = [word.time for word in recording.words]
        self._lock = threading.Lock()
        self._at, self._speed, self._is_playing, self._jumps = 0.0, speed, False, 0
        self._since = time.monotonic()
        self._coverage = _Coverage(recording, self._home.tool)

    def timeline(self) -> TimelineView:
        """Return where the recording is."""
        with self._lock:
            self._pass_time()
            return TimelineView(
                self._recording.duration, self._at, self._speed, self._is_playing, self._jumps
            )

    def play(self, *, is_playing: bool) -> None:
        """Go on, from the start if it was at its end, or stand."""
        with self._lock:
            self._pass_time()
            if is_playing and self._at >= self._recording.duration:
                self._at, self._jumps = 0.0, self._jumps + 1
            self._is_playing = is_playing

    def seek(self, at: float) -> None:
        """Show another time, s."""
        with self._lock:
            self._pass_time()
            self._at = min(max(at, 0.0), self._recording.duration)
            self._jumps += 1

    def set_speed(self, speed: float) -> None:
        """Play ``speed`` seconds of the recording per second."""
        with self._lock:
            self._pass_time()
            self._speed = min(max(speed, SPEEDS[0]), SPEEDS[1])

    def way(self) -> list[Point]:
        """Return the places up to now."""
        count = bisect_right(self._times, self.timeline().at)
        return [(float(x), float(y)) for x, y in self._recording.trace[:count, 1:3]]

    def _pass_time(self) -> None:
        now = time.monotonic()
        if self._is_playing:
            self._at += self._speed * (now - self._since)
            if self._at >= self._recording.duration:
                self._at, self._is_playing = self._recording.duration, False
        self._since = now

    def limits(self) -> view.PageLimits:
        """Return what may be asked for: to drive nowhere."""
        return view.PageLimits(0.0, 0.0)

    def home(self) -> view.HomeView:
        """Return the home of the run."""
        return self._home

    def robot(self) -> view.RobotView:
        """Return the robot as it was at the time that is shown."""
        at = self.timeline().at
        row, pose = self._row_at(at)
        word = self._recording.words[max(bisect_right(self._word_times, at) - 1, 0)]
        wanted = row["wanted"]
        snapshot = VacuumSnapshot(
            word.state,
            word.phase,
            word.message,
            word.room,
            row["covered"],
            wanted,
            row["covered"] / wanted if wanted > 0.0 else 0.0,
            row["to_go"],
            told(row["battery"]),
            hindrance=_hindrance_of(word),
        )
        return view.RobotView(
            time=at,
            pose=pose,
            doubt=word.doubt,
            speed=row["speed"],
            dirt=told(row["dirt"]),
            held="",
            vacuum=snapshot,
            scan=view.NO_POINTS,
            path=view.NO_POINTS,
            last=self._report(at),
        )

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return the map as it was at the end, or what was swept until now."""
        if name is view.LayerName.COVERAGE:
            at = self.timeline().at
            with self._lock:
                return self._coverage.at(bisect_right(self._times, at))
        cells = self._recording.layers.get(name.value)
        if cells is None:
            return None
        return view.GridLayer(1, cells.resolution, cells.origin_x, cells.origin_y, cells.cells)

    def _row_at(self, at: float) -> tuple[dict[str, float], tuple[float, float, float]]:
        """Return the row of a time, and the pose between it and the next one."""
        trace = self._recording.trace
        index = max(bisect_right(self._times, at) - 1, 0)
        after = min(index + 1, len(trace) - 1)
        row = dict(zip(TRACE, trace[index].tolist(), strict=True))
        here, there = trace[index].astype(np.float64), trace[after].astype(np.float64)
        span = there[0] - here[0]
        share = (at - here[0]) / span if span > 0.0 else 0.0
        if np.hypot(*(there - here)[1:3]) > _CARRIED:
            share = 0.0
        x, y = (here + share * (there - here))[1:3]
        theta = here[3] + share * wrap_angle(there[3] - here[3])
        return row, (float(x), float(y), wrap_angle(float(theta)))

    def _report(self, at: float) -> CleanReport | None:
        """Return how it ended, once it has."""
        if at < self._recording.duration - _END:
            return None
        return self._figures.report

    def _refuse(self, *_: Any) -> None:
        home = self._figures.source.home
        raise RequestRefusedError(
            f"this is a recorded run of {home!r}, and nothing is driven; `roomba play` has a robot "
            "that obeys"
        )

    clean = explore = go_to = dock = pause = resume = stop = locate = empty_bin = _refuse
    empty_at_station = replace_bag = _refuse
    emergency_stop = release = drive = put_zone = remove_zone = rename_room = _refuse
    join_rooms = split_room = undo_rooms = set_top_speed = change_rooms = _refuse


def _hindrance_of(word: Word) -> Hindrance:
    """Return what is told of a hindrance; NONE of one that only a newer program knows."""
    known = {hindrance.value: hindrance for hindrance in Hindrance}
    return known.get(word.hindrance, Hindrance.NONE)


def _home_of(recording: RunRecording) -> view.HomeView:
    try:
        return home_from(dict(recording.home))
    except (LookupError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise RunFileError(
            f"expected a recording with the home that it is of, got another one ({error!r:.200})"
        ) from error


class _Coverage:
    """What was swept up to a row of a trace; later rows are added, earlier ones begin anew."""

    def __init__(self, recording: RunRecording, tool: float) -> None:
        self._trace = recording.trace
        self._sweeps = recording.column("sweeps") > 0.5
        cells = recording.layers.get("map")
        self._visits: Visits | None = None
        if cells is not None:
            rows, columns = cells.cells.shape
            frame = GridFrame(cells.resolution, cells.origin_x, cells.origin_y, rows, columns)
            self._visits = Visits(frame, tool)
        self._done = 0

    def at(self, count: int) -> view.GridLayer | None:
        """Return what the first ``count`` rows swept."""
        visits = self._visits
        if visits is None:
            return None
        if count < self._done:
            visits.clear()
            self._done = 0
        for index in range(self._done, count):
            self._sweep(visits, index)
        self._done = count
        return view.GridLayer.over(visits.frame, visits.counts.copy(), 1)

    def _sweep(self, visits: Visits, index: int) -> None:
        if not self._sweeps[index]:
            visits.lift()
            return
        now, x, y = (float(value) for value in self._trace[index, :3])
        before = self._trace[index - 1, 1:3] if index and self._sweeps[index - 1] else (x, y)
        from_x, from_y = float(before[0]), float(before[1])
        length = float(np.hypot(x - from_x, y - from_y))
        steps = 1 if length > _CARRIED else max(1, int(np.ceil(length / _STEP)))
        for step in range(1, steps + 1):
            share = step / steps
            visits.sweep(now, from_x + share * (x - from_x), from_y + share * (y - from_y))
