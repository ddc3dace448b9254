"""A lidar on a line that is unplugged, silent, and there again."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.waiting import wait_until

from roomba.drivers.lidars.reader import LidarReader
from roomba.drivers.line import Line, LineError
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.readings import ScanReading

SCAN = ScanReading(0.0, np.ones(360, np.float32), LidarModel.all_around(360, 0.1, 8.0))


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


class ShortLine:
    """A line that is gone when it is told so."""

    is_gone = False
    is_closed = False
    has = b""

    def write(self, data: bytes) -> None: ...

    def read(self, seconds: float) -> bytes:
        if self.is_gone:
            raise LineError("the line is gone")
        return self.has

    def discard(self) -> None: ...

    def close(self) -> None:
        self.is_closed = True


class EachByteAScan:
    begun = 0

    def begin(self, line: Line) -> None:
        self.begun += 1

    def take(self, data: bytes, arrived: float) -> list[ScanReading]:
        return [SCAN for _ in data]


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_the_newest_scan_is_kept(clock: Clock) -> None:
    line, language = ShortLine(), EachByteAScan()
    reader = LidarReader(lambda: line, language, clock)
    assert reader.newest() is None
    assert reader.trouble
    line.has = b"x"
    reader.serve(0.0)
    assert reader.newest() is SCAN
    assert reader.trouble == ""
    reader.stop()
    assert line.is_closed


def test_silence_is_told_with_what_to_look_for(clock: Clock) -> None:
    line = ShortLine()
    reader = LidarReader(lambda: line, EachByteAScan(), clock)
    reader.serve(0.0)
    clock.now = 2.0
    reader.serve(0.0)
    assert "got none for 2 s. Does it turn" in reader.trouble
    line.has = b"x"
    reader.serve(0.0)
    assert reader.trouble == ""


def test_a_line_that_is_gone_is_opened_anew_once_a_second(clock: Clock) -> None:
    lines = [ShortLine(), ShortLine()]
    opened: list[ShortLine] = []
    language = EachByteAScan()

    def open_one() -> Line:
        if len(opened) == 1 and clock.now < 2.0:
            raise LineError("expected a lidar")
        opened.append(lines[len(opened)])
        return opened[-1]

    reader = LidarReader(open_one, language, clock)
    reader.serve(0.0)
    lines[0].is_gone = True
    reader.serve(0.0)
    assert reader.trouble == "the line is gone"
    assert lines[0].is_closed
    reader.serve(0.0)
    assert reader.trouble == "the line is gone"
    clock.now = 1.5
    reader.serve(0.0)
    assert reader.trouble == "expected a lidar"
    clock.now = 2.6
    lines[1].has = b"x"
    reader.serve(0.0)
    assert (len(opened), language.begun, reader.trouble) == (2, 2, "")


def test_its_thread_reads_until_it_is_stopped(clock: Clock) -> None:
    line = ShortLine()
    line.has = b"x"
    reader = LidarReader(lambda: line, EachByteAScan(), clock)
    reader.start()
    reader.start()
    wait_until(lambda: reader.newest() is SCAN, 5.0, "a scan")
    reader.stop()
    assert line.is_closed
    reader.start()
    wait_until(lambda: reader.trouble == "", 5.0, "it reads on")
    reader.stop()
