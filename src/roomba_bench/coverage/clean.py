"""One clean by our robot, closed loop and headless, judged by the benchmark's own evaluator."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

import numpy as np

from roomba.arrays import Floats
from roomba.files.shipped import HOMES
from roomba.headless.burst import LONGEST_BURST
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.perception.localization.estimate import Knowledge
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home
from roomba_bench.coverage.changes import Change, Changed, changed
from roomba_bench.coverage.floor import (
    TOOL,
    Disc,
    Patch,
    Reachable,
    drawn,
    exact_share,
    length,
    patches,
    reachable,
    turning,
)
from roomba_bench.localization.robot import WRONG
from roomba_bench.ours_sim import ROBOT

Sensors = Literal["ideal", "noisy"]

_LOOKED_AT: Final = 20
"""Ticks, a second: in changed homes the robot's belief is checked at least so often."""
LEAST_PATCH: Final = 0.004
"""m2; smaller missed patches are not listed."""


@dataclass(frozen=True)
class Task:
    """A clean to make: ``folder`` is of map_server maps, or "" for a shipped home.

    ``change`` is the kind of difference from the map, made by the seed.
    """

    home: str
    seed: int = 0
    folder: str = ""
    sensors: Sensors = "noisy"
    change: Change | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Clean:
    """The result of a clean: m, m2, rad, s; shares 0..1.

    ``exact`` is the share by the middles of cells. ``setup``, ``wall`` and ``cpu`` are s of this
    machine; ``planning`` is the wall time of the robot's ``plans``. ``told`` is the missed floor
    that the robot reports, with reasons, ``missed`` the truly missed floor. ``wrong`` is how long
    the robot took a wrong pose for known. ``what`` says how the home differed from its map.
    ``poses`` has rows t, x, y, theta, true ones, from the start on; it is empty if they were not to
    be kept.
    """

    task: Task
    outcome: CleanOutcome
    message: str
    is_docked: bool
    area: float
    share: float
    exact: float
    path: float
    turning: float
    hits: int
    seconds: float
    setup: float
    wall: float
    cpu: float
    planning: float
    plans: int
    told: tuple[tuple[MissReason, Patch], ...]
    missed: tuple[Patch, ...]
    wrong: float
    what: str = ""
    poses: Floats = field(default_factory=lambda: np.zeros((0, 4)), repr=False)

    @property
    def ratio(self) -> float:
        """Way driven by the least way that could sweep the floor."""
        return self.path / (self.area / TOOL)

    @property
    def told_area(self) -> float:
        """Missed floor that the robot reports, m2."""
        return sum(patch.area for _, patch in self.told)

    @property
    def missed_area(self) -> float:
        """Truly missed floor, m2."""
        return (1.0 - self.share) * self.area

    @property
    def is_home_and_done(self) -> bool:
        """Whether the robot says that it did all, and stands on its station."""
        return self.is_docked and self.outcome is CleanOutcome.COMPLETED

    def is_short(self, least: float) -> bool:
        """Whether the robot swept less than a share, or did not come home."""
        return self.share < least or not self.is_home_and_done

    def is_silent(self, least: float) -> bool:
        """Whether the robot hid that it fell short, by claimed success or too little missed."""
        if not self.is_docked:
            return self.outcome is CleanOutcome.COMPLETED
        hidden = self.missed_area - self.told_area
        return self.share < least and hidden > (1.0 - least) * self.area


class _Observed(HeadlessMission):
    """A robot whose believed pose is compared with the true one now and then."""

    wrong = 0.0

    def advance(self) -> None:
        """Let some ticks pass, and look."""
        before = self.seen.time
        super().advance()
        believed, true = self.localizer.estimate, self.seen.pose
        off = true.distance_to(believed.pose.x, believed.pose.y)
        if believed.knowledge is Knowledge.KNOWN and off > WRONG:
            self.wrong += self.seen.time - before


def home_named(name: str, folder: str = "") -> Home:
    """Return a shipped home, or the one of a map of a folder."""
    return load_home(str(Path(folder) / f"{name}.yaml") if folder else name, HOMES)


def true_floor(home: Home, start: tuple[float, float], things: Sequence[Disc] = ()) -> Reachable:
    """Return the floor that can be swept in truth by a robot that never enters what its map shows.

    What moves by itself is left out.
    """
    solid = home.solid | home.drop | home.map.solid
    return reachable(solid, home.frame, start, things, ~home.map.solid)


def clean(task: Task, keeps_poses: bool = False) -> Clean:
    """Make a clean of the whole home, from the station."""
    there = Changed(home_named(task.home, task.folder))
    if task.change is not None:
        there = changed(there.home, task.change, task.seed)
    home, things = there.home, there.things
    setup = time.process_time()
    robot = _Observed(
        home,
        ROBOT.with_sensors(task.sensors),
        seed=task.seed,
        longest_burst=LONGEST_BURST if task.change is None else _LOOKED_AT,
    )
    setup = time.process_time() - setup
    for thing in things:
        robot.simulator.place_obstacle(*thing)
    here = robot.simulator.pose
    wall, cpu = time.perf_counter(), time.process_time()
    record = robot.clean()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    poses = np.concatenate([np.array([[0.0, here.x, here.y, here.theta]]), record.poses])
    floor = true_floor(home, (robot.context.staging.x, robot.context.staging.y), things)
    left = floor.floor & ~drawn(floor.frame, poses[:, 1:3])
    result = record.result
    return Clean(
        task=task,
        outcome=result.outcome,
        message=result.message,
        is_docked=robot.seen.battery.is_docked,
        area=floor.area,
        share=1.0 - float(np.count_nonzero(left)) / np.count_nonzero(floor.floor),
        exact=exact_share(floor, poses[:, 1:3]),
        path=length(poses[:, 1:3]),
        turning=turning(poses[:, 3]),
        hits=record.hits,
        seconds=result.duration,
        setup=setup,
        wall=wall,
        cpu=cpu,
        planning=record.planning,
        plans=record.plans,
        told=tuple((each.reason, Patch(each.area, each.x, each.y)) for each in result.missed),
        missed=patches(floor.frame, left, LEAST_PATCH),
        wrong=robot.wrong,
        what=there.what,
        poses=poses if keeps_poses else np.zeros((0, 4)),
    )
