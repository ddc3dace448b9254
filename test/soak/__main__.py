"""``./roomba soak [MINUTES] [--seed N]``: faults in the middle of cleans, and what came of them.

It is no test of pytest: it takes as long as it is given. A table is printed at the end; the exit
status is 1 when a promise was broken.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import rospy
from actionlib import SimpleGoalState
from actionlib_msgs.msg import GoalStatus
from fixtures.forked import run_forked
from fixtures.graph import RUN, RosGraph
from fixtures.probe import Probe
from fixtures.tiny_home import tiny_home
from geometry_msgs.msg import Twist
from roomba_robot.msg import CleanAction, CleanGoal, VacuumState
from std_msgs.msg import String

from roomba_ros.runtime.action_client import ActionClient

NOTICED: Final = 1.0
"""s of wall time until a fault is told of, as docs/reliability.md promises."""
BACK: Final = 5.0
"""s of wall time until a process that ended is back."""
STOPPED: Final = 2.0
"""s of wall time for which a stopped process is waited for before that."""
GOES_ON: Final = 30.0
"""s of wall time until the clean got farther."""
CALM: Final = (2.0, 8.0)
"""s of wall time between two faults."""
ENDED: Final = 600.0
"""s of wall time that a clean takes at most."""
KILLABLE: Final = tuple(name for name in RUN if name != "home_sim_node")
"""The body is required: all end with it."""


@dataclass
class Row:
    """What came of one kind of fault."""

    times: int = 0
    noticed: list[float] = field(default_factory=list)
    back: list[float] = field(default_factory=list)
    broken: list[str] = field(default_factory=list)


class Soak:
    """A robot that cleans again and again, and is disturbed."""

    def __init__(self, graph: RosGraph, seed: int) -> None:
        """Become a client of the robot."""
        self._graph, self._random = graph, random.Random(seed)
        self._probe = Probe(graph, "soak")
        self._state, self._trouble = VacuumState(), [""]
        self.rows: dict[str, Row] = {}
        self._client = ActionClient("clean", CleanAction)
        rospy.Subscriber("/vacuum/state", VacuumState, self._on_state)
        rospy.Subscriber("/trouble", String, lambda told: self._trouble.append(told.data))

    def _on_state(self, state: VacuumState) -> None:
        self._state = state

    def run(self, seconds: float) -> None:
        """Disturb it for so long, and let the last clean end."""
        _until(lambda: bool(self._client.wait_for_server(rospy.Duration(0.01))), 60.0)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._keep_cleaning()
            time.sleep(self._random.uniform(*CALM))
            self._random.choice((self._kill, self._stop, self._kill_master, self._flood))()
        self._finish()

    def _keep_cleaning(self) -> None:
        """Begin another clean when the last one has ended, each of them exactly once."""
        row = self.rows.setdefault("clean", Row())
        if row.times > 0 and not self._has_ended():
            return
        self._judge(row)
        ready = ("docked", "idle")
        if _until(lambda: self._state.phase in ready, ENDED) is not None:
            self._client.send_goal(CleanGoal())
            row.times += 1
            _until(lambda: self._state.phase == "cleaning", 60.0)

    def _finish(self) -> None:
        row = self.rows["clean"]
        if _until(self._has_ended, ENDED) is None:
            row.broken.append(f"the last one has not ended: {self._state.phase}")
        else:
            self._judge(row)

    def _has_ended(self) -> bool:
        return bool(self._client.simple_state == SimpleGoalState.DONE)

    def _judge(self, row: Row) -> None:
        """Note a clean that did not end as it should."""
        if row.times > 0 and self._client.get_state() != GoalStatus.SUCCEEDED:
            said = self._client.get_goal_status_text()
            row.broken.append(f"clean {row.times}: status {self._client.get_state()}, {said}")

    def _kill(self) -> None:
        name = self._random.choice(KILLABLE)
        self._disturb(f"kill {name}", name, signal.SIGKILL, BACK)

    def _stop(self) -> None:
        name = self._random.choice(KILLABLE)
        self._disturb(f"stop {name}", name, signal.SIGSTOP, STOPPED + BACK)

    def _kill_master(self) -> None:
        self._disturb("kill master", "master", signal.SIGKILL, BACK)

    def _disturb(self, what: str, name: str, number: signal.Signals, back: float) -> None:
        """Do something to a process; note when that was told, and when all was well again."""
        row = self.rows.setdefault(what, Row())
        row.times += 1
        old, told = self._graph.process(name), len(self._trouble)
        os.kill(old, number)
        if name != "supervisor_node":
            self._note(row, row.noticed, "noticed", NOTICED, lambda: any(self._trouble[told:]))

        def is_well() -> bool:
            return self._graph.process(name) != old and self._is_well(name)

        self._note(row, row.back, "back", back, is_well)
        self._goes_on(row)

    def _flood(self) -> None:
        """Steer ten thousand times by what is no number, as fast as it goes."""
        row = self.rows.setdefault("flood /cmd_vel", Row())
        row.times += 1
        publisher, wish = self._probe.publisher("/cmd_vel", Twist), Twist()
        wish.linear.x = float("nan")
        for _ in range(10_000):
            publisher.publish(wish)
        self._goes_on(row)

    def _goes_on(self, row: Row) -> None:
        """Note if the clean does not get farther; one that ends meanwhile did."""
        if self._state.phase != "cleaning":
            return
        before = self._state.covered

        def went_on() -> bool:
            return bool(self._state.covered > before + 0.01) or self._state.phase != "cleaning"

        if _until(went_on, GOES_ON) is None:
            row.broken.append(f"the clean does not go on: {self._state.message}")
        elif self._state.phase == "error":
            row.broken.append(f"error: {self._state.message}")

    def _note(
        self, row: Row, took: list[float], what: str, promise: float, holds: Callable[[], bool]
    ) -> None:
        seconds = _until(holds, 10.0 * promise)
        if seconds is None or seconds > promise:
            row.broken.append(f"{what} after {seconds or 10.0 * promise:.2f} s, not {promise:g}")
        if seconds is not None:
            took.append(seconds)

    def _is_well(self, name: str) -> bool:
        if name == "master":
            return self._graph.master_answers()
        return self._trouble[-1] == "" and self._graph.answers(name)

    def table(self) -> str:
        """Return what came of it all."""
        lines = [f"{'fault':42} times  noticed  back   (s of wall time, the longest)"]
        for what, row in sorted(self.rows.items()):
            longest = [f"{max(took):.2f}" if took else "-" for took in (row.noticed, row.back)]
            lines.append(f"{what:42} {row.times:5}  {longest[0]:>7}  {longest[1]:>5}")
            lines += [f"    broken: {broken}" for broken in row.broken]
        return "\n".join(lines)


def _until(holds: Callable[[], bool], seconds: float) -> float | None:
    """Return after how many s something was so; None if it was not in time."""
    begin = time.monotonic()
    while not holds():
        if time.monotonic() - begin > seconds:
            return None
        time.sleep(0.01)
    return time.monotonic() - begin


def main(arguments: list[str] | None = None) -> int:
    """Run the robot and disturb it."""
    parser = argparse.ArgumentParser(prog="./roomba soak", description=__doc__)
    parser.add_argument("minutes", type=float, nargs="?", default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="roomba_soak_") as name, RosGraph(Path(name)) as graph:
        graph.launch(f"home:={tiny_home(Path(name))}")
        told = Path(name) / "told"

        def soak() -> None:
            made = Soak(graph, given.seed)
            made.run(60.0 * given.minutes)
            broken = sum(len(row.broken) for row in made.rows.values())
            told.write_text(f"{broken}\n{made.table()}", encoding="utf-8")

        run_forked(soak, deadline=120.0 * given.minutes + 2.0 * ENDED)
        broken, _, table = told.read_text(encoding="utf-8").partition("\n")
    print(
        f"{table}\n{broken} promises were broken in {given.minutes:g} minutes (seed {given.seed})"
    )
    return 1 if int(broken) else 0


if __name__ == "__main__":
    sys.exit(main())
