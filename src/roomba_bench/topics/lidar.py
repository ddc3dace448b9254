"""How many scans a second, and whether they are exact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.files.shipped import HOMES
from roomba.grid import GridFrame
from roomba.world.layers.layer import load_home
from roomba_bench import ours_sim
from roomba_bench.bench import Bench
from roomba_bench.checks import agreed
from roomba_bench.contestants import Contestant, Local
from roomba_bench.floors import Floor, building, floors_of_folder, free_poses
from roomba_bench.lidar.arithmetic import arithmetic
from roomba_bench.lidar.ray_marching import RayMarching
from roomba_bench.ours_sim import ROBOT
from roomba_bench.peers.protocol import CHECKED_POSES, Work
from roomba_bench.record import Better, Record, gain
from roomba_bench.rounds import Outcome

_TOPIC = "lidar"
_POSES = 1000
_EXACT_POSES = 400
_AIM = 300_000.0
_ARITHMETIC = "arithmetic alone"
_SHARE_OF_ARITHMETIC = 0.25
_OFF = 0.01
"""m; a beam that grazes a corner may hit a surface behind it."""
_SAME_RANGE = 0.02
"""Relative error of the mean range."""
_BUILDINGS = (200, 400, 800, 1600)
PEERS: tuple[tuple[str, str, dict[str, object]], ...] = (
    ("mujoco", "simulators.mujoco", {}),
    ("Box2D", "simulators.box2d", {}),
    ("pymunk", "simulators.pymunk", {}),
    ("pybullet", "simulators.pybullet", {}),
    ("ir-sim (boxes)", "simulators.irsim", {"as_boxes": True}),
    ("ir-sim (grid map)", "simulators.irsim", {"as_boxes": False}),
)
"""Name in the table, script, and what the script is told beside the case."""


Poses = NDArray[np.float64]


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    home = load_home("apartment", HOMES)
    apartment = Floor("apartment", home.solid, home.frame)
    bench.say("apartment")
    records = [*_apartment_rows(bench, apartment), *_exactness_rows(apartment)]
    for size in _BUILDINGS[:2] if bench.is_quick else _BUILDINGS:
        solid = building(size)
        records.append(_row(bench, Floor("building", solid, GridFrame(0.05, 0.0, 0.0, size, size))))
    for floor in floors_of_folder(bench.maps) if bench.maps else ():
        records.append(_row(bench, floor))
    return records


def peers_of(bench: Bench, case: dict[str, object]) -> list[Contestant]:
    """Return the peers of lidar and sim in a case."""
    peers: list[Contestant] = [
        bench.peer(name, module, {**case, **more}, name.split(" (")[0])
        for name, module, more in PEERS
    ]
    return [*peers, bench.unavailable("range-libc")]


def case_of(bench: Bench, floor: Floor, poses: Poses) -> dict[str, object]:
    """Return a floor as peers are told of it; their robot starts at the first of the poses."""
    return {
        "solid": bench.save("solid", floor.solid),
        "poses": bench.save("poses", poses),
        "resolution": floor.frame.resolution,
        "origin": [floor.frame.origin_x, floor.frame.origin_y],
        "radius": ROBOT.body.radius,
        "beams": ROBOT.lidar.beams,
        "reach": ROBOT.lidar.max_range,
        "dt": ours_sim.DT,
        "start": poses[0].tolist(),
    }


def marching(floor: Floor) -> RayMarching:
    """Return the plain reference for a floor."""
    return RayMarching(floor, ROBOT.lidar.beams, ROBOT.lidar.max_range, ROBOT.body.radius)


def _contestants(floor: Floor, poses: Poses) -> list[Contestant]:
    return [
        Local("ours", lambda: ours_sim.scanning(floor, poses)),
        Local("numba ray marching", lambda: _marching_work(floor, poses)),
    ]


def _marching_work(floor: Floor, poses: Poses) -> Work:
    march = marching(floor)

    def work() -> float:
        march.scan(poses)
        return float(len(poses))

    return Work(work, {"mean range": float(np.mean(march.scan(poses[:CHECKED_POSES])))})


def _apartment_rows(bench: Bench, floor: Floor) -> list[Record]:
    poses = free_poses(floor, _POSES)
    case = {**case_of(bench, floor, poses), "case": "scan"}
    beams = ROBOT.lidar.beams
    floor_of_arithmetic = Local(_ARITHMETIC, lambda: arithmetic(poses, beams))
    contestants = [*_contestants(floor, poses), *peers_of(bench, case), floor_of_arithmetic]
    record = _record(floor, bench.compete(contestants), _AIM)
    return [record, gain(record, _ARITHMETIC, _SHARE_OF_ARITHMETIC)]


def _row(bench: Bench, floor: Floor) -> Record:
    bench.say(f"{floor.name}, {floor.frame.columns} x {floor.frame.rows} cells")
    return _record(floor, bench.compete(_contestants(floor, free_poses(floor, _POSES))), None)


def _record(floor: Floor, outcomes: list[Outcome], aim: float | None) -> Record:
    ours, *peers = outcomes
    edges = f", {ours.facts['edges']:.0f} edges" if "edges" in ours.facts else ""
    return Record(
        _TOPIC,
        f"{floor.name}, {floor.frame.columns} x {floor.frame.rows} cells{edges}",
        "360 beams to 12 m, one core",
        ours.rate,
        "scans/s",
        Better.HIGHER,
        aim,
        tuple(agreed(ours, peer, "mean range", _SAME_RANGE).figure() for peer in peers),
        ours.error,
    )


def _exactness_rows(floor: Floor) -> list[Record]:
    """Return how far our ranges are from those of ray marching."""
    poses = free_poses(floor, _EXACT_POSES, seed=2)
    case = f"{floor.name}, {_EXACT_POSES} scans against numba ray marching"
    try:
        ours = ours_sim.scans(floor, poses)
    except Exception as error:
        # The simulator may be unfinished: then the row says so.
        return [Record(_TOPIC, case, "error", None, "m", Better.LOWER, error=str(error))]
    both = np.isfinite(ours)
    errors = np.abs(ours - marching(floor).scan(poses))[both]
    return [
        Record(_TOPIC, case, "error, median", float(np.median(errors)), "m", Better.LOWER, 1e-5),
        Record(
            _TOPIC,
            case,
            "beams more than 1 cm off (they graze corners)",
            100.0 * float(np.mean(errors > _OFF)),
            "%",
            Better.LOWER,
            0.01,
        ),
    ]
