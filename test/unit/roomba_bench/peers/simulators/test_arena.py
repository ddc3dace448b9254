"""Scans of a simulating peer, against ours at the same poses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba_bench import ours_sim
from roomba_bench.floors import Floor, building, free_poses
from roomba_bench.ours_sim import ROBOT
from roomba_bench.peers.protocol import CHECKED_POSES
from roomba_bench.peers.simulators.arena import Arena, Engine, work_of
from roomba_bench.topics.lidar import case_of, marching


class _Marching:
    """An engine that only scans, by marching along its rays."""

    def __init__(self, floor: Floor) -> None:
        self._march, self._pose = marching(floor), (0.0, 0.0, 0.0)

    def place(self, x: float, y: float, theta: float) -> None:
        self._pose = x, y, theta

    def scan(self) -> NDArray[np.float64]:
        return np.asarray(self._march.scan(np.array([self._pose]))[0], np.float64)


class _Saving:
    """A benchmark that only saves arrays."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def save(self, name: str, array: NDArray[np.generic]) -> str:
        np.save(self._folder / f"{name}.npy", array)
        return str(self._folder / f"{name}.npy")


def test_a_peer_and_ours_tell_the_mean_range_of_the_same_poses(tmp_path: Path) -> None:
    floor = Floor("building", building(200), GridFrame(0.05, 0.0, 0.0, 200, 200))
    poses = free_poses(floor, 10 * CHECKED_POSES)
    case = {**case_of(_Saving(tmp_path), floor, poses), "case": "scan"}  # type: ignore[arg-type]
    engine: Engine = _Marching(floor)  # type: ignore[assignment]
    peer = work_of(engine, Arena.of(case), case).facts["mean range"]
    ours = ours_sim.scanning(floor, poses).facts["mean range"]
    assert ROBOT.lidar.max_range >= peer > 1.0
    assert ours == pytest.approx(peer, rel=1e-3)
    # Of all the poses it is another one, of which no peer can tell.
    assert ours_sim.scanning(floor, poses[CHECKED_POSES:]).facts["mean range"] != pytest.approx(
        peer, rel=1e-3
    )
