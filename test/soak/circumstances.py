"""The clock is set or stands, the disk is full, while the robot cleans."""

from __future__ import annotations

import contextlib
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import rospy
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from rosgraph_msgs.msg import Clock
from soak.arena import Arena
from soak.cleaner import Cleaner
from soak.rows import Row, in_child, tell, until

HOUR: Final = 3600.0
TOLD: Final = 5.0
"""s of wall time until a full disk is reported, and until all is well after there is room again."""
RETRIED: Final = 10.0
_SPEED: Final = 3.0
"""Robot seconds per second."""
_PERIOD: Final = 0.05
"""s between two messages of the clock."""
_STANDS: Final = 8.0
"""s of wall time without messages of the clock."""
_ROOM: Final = "64m"
"""The size of the disk."""


class SetClock:
    """Publishes a clock, which can be set, and can stand."""

    def __init__(self) -> None:
        """Begin to publish."""
        self._publisher = rospy.Publisher("/clock", Clock, queue_size=1, tcp_nodelay=True)
        self.now, self.runs = 10_000.0, True
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(_PERIOD / _SPEED)
            if self.runs:
                self.now += _PERIOD
                # This node may be ending.
                with contextlib.suppress(rospy.ROSException):
                    self._publisher.publish(rospy.Time.from_sec(self.now))


def clock(arena: Arena) -> list[Row]:
    """Set the clock back and forth, and take it away."""
    with RosGraph(arena.folder) as graph:
        graph.start_master()

        def work() -> list[Row]:
            graph.set_param("/use_sim_time", True)
            probe, given = Probe(graph, "soak"), SetClock()
            graph.start_run(f"home:={tiny_home(arena.folder)}", "clock:=false")
            wait_until(graph.all_up, START_DEADLINE, lambda: graph.programs[-1].output)
            cleaner = Cleaner(graph, probe)
            rows = [set_clock(given, cleaner, jump) for jump in (-10.0, HOUR, -HOUR)]
            rows.append(take_clock(given, cleaner))
            cleaner.finish()
            return [cleaner.row, *rows]

        return in_child(arena.folder, work, 1800.0)


def set_clock(given: SetClock, cleaner: Cleaner, jump: float) -> Row:
    """Set the clock by so many s while the robot cleans."""
    cleaner.keep_cleaning()
    row = Row(f"clock set by {jump:+g} s", 1)
    tell(row.what)
    given.now += jump
    cleaner.goes_on(row)
    return row


def take_clock(given: SetClock, cleaner: Cleaner) -> Row:
    """Let the clock be gone for a while."""
    cleaner.keep_cleaning()
    row = Row(f"clock gone for {_STANDS:g} s", 1)
    tell(row.what)
    given.runs = False
    time.sleep(_STANDS)
    given.runs = True
    cleaner.goes_on(row)
    return row


def disk(arena: Arena) -> list[Row]:
    """Fill a small disk that the robot keeps its files on, and make room again."""
    with small_disk(arena.folder / "ros_home") as home:
        if home is None:
            return [Row("full disk: left out, mounting one needs root")]
        with RosGraph(arena.folder) as graph:
            graph.launch(f"home:={tiny_home(arena.folder)}", "speed:=3")

            def work() -> list[Row]:
                cleaner = Cleaner(graph)
                row = fill(cleaner, home)
                cleaner.finish()
                expect_nothing_left(row, graph, home)
                return [cleaner.row, row]

            return in_child(arena.folder, work, 1800.0)


@contextlib.contextmanager
def small_disk(folder: Path) -> Iterator[Path | None]:
    """Mount a small disk at a folder; None where mounting is refused."""
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={_ROOM}", "tmpfs", str(folder)]
    if subprocess.run(mount, check=False, capture_output=True, timeout=20.0).returncode != 0:
        yield None
        return
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True, timeout=20.0)


def fill(cleaner: Cleaner, home: Path) -> Row:
    """Fill the disk that has the robot's files, and make room again."""
    cleaner.clean()
    row = Row("full disk", 1)
    tell(row.what)
    filler = home / "filler"
    with filler.open("wb", buffering=0) as file:

        def is_full_and_told() -> bool:
            # Fill the room as well that a replaced file leaves.
            with contextlib.suppress(OSError):
                while file.write(bytes(4096)):
                    pass
            return "No space left" in cleaner.state.message

        is_told = row.expect_within("told", TOLD, is_full_and_told)
    cleaner.goes_on(row)
    filler.unlink()
    if is_told:
        row.expect_within(
            "well again", RETRIED, lambda: "No space left" not in cleaner.state.message
        )
    cleaner.goes_on(row)
    return row


def expect_nothing_left(row: Row, graph: RosGraph, home: Path) -> None:
    """Note unfinished files and tracebacks as broken promises."""
    if until(lambda: not list(home.rglob("*.unfinished-*")), TOLD) is None:
        row.broken.append(f"left behind: {list(home.rglob('*.unfinished-*'))}")
    lines = graph.programs[0].output.count("Traceback")
    if lines:
        row.broken.append(f"{lines} tracebacks")
