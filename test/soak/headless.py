"""``./roomba soak --headless HOURS``: a robot that lives for hours of its clock, and what it costs.

It cleans, charges and rests in its thread as under ``./roomba play``. Memory, file descriptors and
threads are looked at each hour. The first two hours are those of growing caches and do not count.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from fixtures.robots.missions import HOME

from roomba.clean_request import CleanRequest
from roomba.headless.live.robot import LiveRobot
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanResult
from roomba.mission.phases.machine import Event
from roomba.vocabulary import Phase

MOST_GROWTH: Final = 1.0
"""MB an hour of the robot's clock."""
MOST_DESCRIPTORS: Final = 2
WARM: Final = 2
"""Hours."""
HOUR: Final = 3600.0
REST: Final = 600.0
"""s on the station between two cleans."""
EXAMPLES: Final = 10
"""Robots to which everything happens, for each hour."""
ROOT: Final = Path(__file__).resolve().parents[2]
FAULTS: Final = "test/unit/robot/test_any_fault.py"
_LOOK: Final = 0.2
"""s of wall time between two looks at the robot."""
_STANDS_STILL: Final = 300.0
"""s of wall time in which the robot's clock must go on."""
_CRUMBS: Final = 0.5
"""g that fall before each clean."""


class Cost(NamedTuple):
    """What the process holds at an hour: MB, and how many."""

    hour: float
    memory: float
    descriptors: int
    threads: int


class Life:
    """Cleans and rests, as often as there is time for; called by the robot's own thread."""

    def __init__(self) -> None:
        self.results: list[CleanResult] = []
        self.now = 0.0
        self._rests_since = 0.0

    def look(self, robot: HeadlessMission) -> None:
        """Begin a clean when it has rested, take the result of one that ended."""
        self.now = robot.seen.time
        mission = robot.mission
        result = mission.take_result()
        if result is not None:
            self.results.append(result)
            self._rests_since = self.now
            robot.simulator.empty_bin()
            robot.look()
            mission.command(Event.EMPTIED, robot.senses())
        rested = self.now - self._rests_since >= REST
        if mission.state.phase is Phase.DOCKED and rested and mission.cleaning is None:
            robot.simulator.spill(1.2, 0.6, 0.4, _CRUMBS)
            mission.clean(CleanRequest(), robot.senses())


def live(hours: float) -> tuple[list[Cost], list[CleanResult]]:
    """Return what each hour cost, and what each clean told."""
    life, robot = Life(), HeadlessMission(HOME)
    lives = LiveRobot(robot, 1e6, lambda _: life.look(robot))
    lives.start()
    costs: list[Cost] = []
    seen, went_on = 0.0, time.monotonic()
    try:
        while life.now < HOUR * hours:
            time.sleep(_LOOK)
            if life.now > seen:
                seen, went_on = life.now, time.monotonic()
            if lives.ending or time.monotonic() - went_on > _STANDS_STILL:
                raise SystemExit(f"the robot's time stands still at {seen:.0f} s: {lives.ending}")
            if life.now >= HOUR * (len(costs) + 1):
                costs.append(cost(life.now / HOUR))
    finally:
        lives.stop()
    return costs, life.results


def cost(hour: float) -> Cost:
    """Return what this process holds now."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return Cost(
        hour,
        pages * os.sysconf("SC_PAGE_SIZE") / 1e6,
        len(os.listdir("/proc/self/fd")),
        len(os.listdir("/proc/self/task")),
    )


def judged(costs: list[Cost], results: list[CleanResult]) -> tuple[str, list[str]]:
    """Return a table, and the promises that were broken."""
    counted = [each for each in costs if each.hour >= WARM]
    lines = ["  hour   memory  descriptors  threads"]
    lines += [
        f"{each.hour:6.1f} {each.memory:5.1f} MB {each.descriptors:12d} {each.threads:8d}"
        for each in costs
    ]
    incomplete = [result for result in results if result.outcome.value != "completed"]
    lines.append(f"{len(results)} cleans, {len(incomplete)} of them not completed")
    broken = [f"a clean was {each.outcome.value}: {each.message}" for each in incomplete]
    if len(counted) < 2:
        return "\n".join(lines), [*broken, f"expected more than {WARM + 1} hours to judge"]
    growth = float(
        np.polyfit([each.hour for each in counted], [each.memory for each in counted], 1)[0]
    )
    lines.append(f"memory grows by {growth:.3f} MB an hour")
    if growth > MOST_GROWTH:
        broken.append(f"memory grows by {growth:.2f} MB an hour, at most {MOST_GROWTH:g}")
    for name, most in (("descriptors", MOST_DESCRIPTORS), ("threads", 0)):
        numbers = [getattr(each, name) for each in counted]
        if max(numbers) - min(numbers) > most:
            broken.append(f"{name}: {min(numbers)} to {max(numbers)}, at most {most} apart")
    return "\n".join(lines), broken


def faults(examples: int) -> list[str]:
    """Let everything happen to so many robots; return what was broken."""
    command = [sys.executable, "-m", "pytest", "-c", "pyproject.toml", "--rootdir", ".", FAULTS]
    environment = os.environ | {"ROOMBA_EXAMPLES": str(examples)}
    ran = subprocess.run(command, cwd=ROOT, env=environment, check=False)
    return [f"{FAULTS} failed, see above"] if ran.returncode else []


def main(hours: float) -> int:
    """Let a robot live, and everything happen to others; return the exit status."""
    table, broken = judged(*live(hours))
    print(table, flush=True)
    broken += faults(max(1, round(EXAMPLES * hours)))
    print("\n".join([*broken, f"{len(broken)} promises were broken in {hours:g} hours"]))
    return 1 if broken else 0
