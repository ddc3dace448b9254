"""How many steps of a robot a second: move, bump, vacuum, lidar."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace

from roomba.files.shipped import HOMES
from roomba.grid import GridFrame
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home
from roomba_bench import ours_sim
from roomba_bench.bench import Bench
from roomba_bench.contestants import Contestant, Local
from roomba_bench.floors import Floor, building, free_poses
from roomba_bench.ours_sim import Drive
from roomba_bench.peers.protocol import Work
from roomba_bench.record import Better, PeerFigure, Record, gain
from roomba_bench.rounds import Outcome
from roomba_bench.topics.lidar import case_of, marching, peers_of

_TOPIC = "sim"
_AIM = 600_000.0
_OVER_MUJOCO = 30.0
_OVER_IRSIM = 500.0
_TWO_CORES = 1.8
_TOGETHER = 20
"""Robots of ours in one call, on one core, to compare with peers: the overhead of a call from
Python would exceed a single robot's steps. The figure of a single robot is in the rows about
fleets."""
_WARM_AIM, _COLD_AIM = 1.0, 6.0
"""s, of a process from its start to its first step."""
_FLEETS = (1, 10, 100, 1000)
_BUILDINGS = (200, 800, 2000)
_START_DEADLINE = 300.0
"""s; a start with nothing compiled."""


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    home = load_home("apartment", HOMES)
    records: list[Record] = []
    for scan_every, when, aim in ((2, "lidar at 10 Hz", _AIM), (1, "lidar at each step", None)):
        bench.say(f"apartment, {when}")
        row = _beside_peers(bench, home, scan_every, when, aim)
        records.append(row)
        if aim is not None:
            records += [
                gain(row, "mujoco", _OVER_MUJOCO),
                gain(row, "ir-sim (boxes)", _OVER_IRSIM),
            ]
    records += [_noise_row(bench, home), _turning_lidar_row(bench, home)]
    bench.say("fleets")
    records += _fleet_rows(bench, home)
    records += _building_rows(bench)
    records.append(_memory_row(home))
    bench.say("starts")
    return records + _start_rows()


def _beside_peers(
    bench: Bench, home: Home, scan_every: int, when: str, aim: float | None
) -> Record:
    floor = Floor(home.name, home.solid, home.frame)
    poses = free_poses(floor, 1, room=0.5)
    case = {**case_of(bench, floor, poses), "case": "drive", "scan_every": scan_every}
    drive = Drive(robots=_TOGETHER, scan_rate=1.0 / (ours_sim.DT * scan_every))

    def march() -> Work:
        return marching(floor).drive(poses[0], ours_sim.DT, scan_every)

    contestants: list[Contestant] = [
        Local("ours", lambda: drive.work(home)),
        Local("numba ray marching", march),
        *peers_of(bench, case),
    ]
    ours, *peers = bench.compete(contestants)
    figures = tuple(peer.figure() for peer in peers)
    return _steps_row(f"apartment, 20 Hz steps, {when}, one core", ours, figures, aim)


def _noise_row(bench: Bench, home: Home) -> Record:
    """Return steps with all sensors' noise, and wheels that slip, beside the same without."""
    ideal = Drive(robots=_TOGETHER)
    noisy = replace(ideal, sensors="noisy")
    case = "apartment, 20 Hz steps, lidar at 10 Hz, one core, with noise"
    return _row_beside(bench, home, case, noisy, "ours, ideal sensors", ideal)


def _turning_lidar_row(bench: Bench, home: Home) -> Record:
    """Return steps with the default lidar, whose beams each have a pose, beside one without."""
    at_once = Drive(robots=_TOGETHER, sensors="noisy")
    turning = replace(at_once, lidar="lds_02")
    case = "apartment, 20 Hz steps, lidar lds_02 that turns, one core, with noise"
    return _row_beside(bench, home, case, turning, "ours, a lidar that measures at once", at_once)


def _row_beside(
    bench: Bench, home: Home, case: str, drive: Drive, name: str, other: Drive
) -> Record:
    """Return the steps of a drive beside those of another one of ours, of this name."""
    ours, beside = bench.compete(
        [Local("ours", _maker(drive, home)), Local(name, _maker(other, home))]
    )
    return _steps_row(case, ours, (PeerFigure(name, "", beside.rate, beside.error),))


def _fleet_rows(bench: Bench, home: Home) -> list[Record]:
    """Return steps of all robots together by their number, and what a second core brings."""
    drives = [Drive(robots=count) for count in _FLEETS]
    largest = drives[-1]
    both = replace(largest, threads=2)
    *alone, two = bench.compete(
        [
            Local(f"{drive.robots} robots, {drive.threads} threads", _maker(drive, home))
            for drive in [*drives, both]
        ]
    )
    records = [
        _steps_row(f"apartment, fleet of {drive.robots}, one thread", outcome)
        for drive, outcome in zip(drives, alone, strict=True)
    ]
    one = alone[-1]
    single = PeerFigure("ours, one thread", "", one.rate, one.error)
    pair = _steps_row(f"apartment, fleet of {both.robots}, two threads", two, (single,))
    return [*records, pair, gain(pair, "ours, one thread", _TWO_CORES)]


def _building_rows(bench: Bench) -> list[Record]:
    """Return steps by the size of the map."""
    records = []
    for size in _BUILDINGS[:2] if bench.is_quick else _BUILDINGS:
        bench.say(f"building of {size} x {size} cells")
        frame = GridFrame(0.05, 0.0, 0.0, size, size)
        home = ours_sim.home_of(Floor("building", building(size), frame))
        [outcome] = bench.compete([Local("ours", _maker(Drive(), home))])
        records.append(_steps_row(f"building, {size} x {size} cells, one robot", outcome))
    return records


def _memory_row(home: Home) -> Record:
    figure = ("apartment", "memory of one more robot in a fleet")
    try:
        value = ours_sim.bytes_per_robot(home)
    except Exception as error:
        # The simulator may be unfinished: then the row says so.
        return Record(_TOPIC, *figure, None, "bytes", Better.LOWER, error=_text(error))
    return Record(_TOPIC, *figure, value, "bytes", Better.LOWER)


def _start_rows() -> list[Record]:
    """Return how long a process takes to its first step, with nothing compiled, and after that."""
    records = []
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
        for state, aim in (("cold", _COLD_AIM), ("warm", _WARM_AIM)):
            started = time.perf_counter()
            done = subprocess.run(
                [sys.executable, "-m", "roomba_bench.start"],
                env=environment,
                capture_output=True,
                check=False,
                text=True,
                timeout=_START_DEADLINE,
            )
            value = time.perf_counter() - started
            figure = ("process start to first step", f"compiled code {state}")
            if done.returncode == 0:
                records.append(Record(_TOPIC, *figure, value, "s", Better.LOWER, aim))
            else:
                reason = (done.stderr.strip().splitlines() or ["it ended badly"])[-1]
                row = Record(_TOPIC, *figure, None, "s", Better.LOWER, aim, error=reason)
                records.append(row)
    return records


def _steps_row(
    case: str, ours: Outcome, peers: tuple[PeerFigure, ...] = (), aim: float | None = None
) -> Record:
    return Record(
        _TOPIC,
        case,
        "whole steps",
        ours.rate,
        "robot-steps/s",
        Better.HIGHER,
        aim,
        peers,
        ours.error,
    )


def _maker(drive: Drive, home: Home) -> Callable[[], Work]:
    return lambda: drive.work(home)


def _text(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
