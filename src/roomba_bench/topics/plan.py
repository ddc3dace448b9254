"""How long it takes to find the way, and how long the way is."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from roomba.arrays import Mask
from roomba.configuration.robot import RobotConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Point
from roomba.planning.path.planner import PathPlanner
from roomba.planning.path.search.grid_path import shortest_grid_path
from roomba.world.layers.layer import load_home
from roomba_bench.bench import Bench
from roomba_bench.contestants import Contestant, Local
from roomba_bench.floors import Cell, apartment, building, far_corners, free_poses, room_for
from roomba_bench.peers.protocol import Work, once
from roomba_bench.record import Better, Record, gain
from roomba_bench.rounds import Outcome, milliseconds
from roomba_bench.shortest import ShortestWays

_TOPIC = "plan"
_BODY_ROOM = 0.20
"""m; the body's radius and a little."""
_MOST_EXCESS = 1.0
"""%."""
_OPTIMAL = 1e-6
"""Relative; two optimal lengths may differ by the order of summation."""


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    records = []
    for name, fits, aim in (
        ("apartment, 204 x 204 cells, corner to corner", room_for(apartment(), _BODY_ROOM), 0.5),
        ("building, 2000 x 2000 cells, corner to corner", ~building(2000), 60.0),
    ):
        bench.say(name)
        records += _grid_rows(bench, name, fits, aim)
    bench.say("any-angle")
    return records + _any_angle_rows(bench)


def _grid_rows(bench: Bench, case: str, fits: Mask, aim: float) -> list[Record]:
    """Return time and length of 8-connected paths."""
    start, goal = far_corners(fits)
    case_of_peers = {"fits": bench.save("fits", fits), "start": start, "goal": goal}
    contestants: list[Contestant] = [
        Local("ours", lambda: _grid_work(fits, start, goal)),
        bench.peer("pyastar2d", "paths.pyastar2d", case_of_peers),
        bench.peer("scikit-image", "paths.scikit_image", case_of_peers),
        bench.peer("scipy", "paths.scipy_graph", case_of_peers),
        bench.peer("networkx", "paths.networkx", case_of_peers),
        bench.peer("scikit-fmm", "paths.scikit_fmm", case_of_peers),
    ]
    ours, *peers = bench.compete(contestants)
    for peer in peers:
        peer.name += _rules(peer)
    time = Record(
        _TOPIC,
        case,
        "shortest 8-connected path",
        None if ours.rate is None else milliseconds(ours.rate),
        "ms",
        Better.LOWER,
        aim,
        tuple(peer.figure(milliseconds) for peer in peers),
        ours.error,
    )
    optimal = peers[2].facts.get("length")
    length = Record(
        _TOPIC,
        case,
        "path length",
        ours.facts.get("length"),
        "cells",
        Better.LOWER,
        None if optimal is None else optimal * (1.0 + _OPTIMAL),
        tuple(peer.fact("length") for peer in peers),
        ours.error,
    )
    return [time, gain(time, "pyastar2d", 2.0), length]


def _rules(outcome: Outcome) -> str:
    """Return how a peer's rules differ from ours."""
    if outcome.name == "scikit-fmm":
        return " (any-angle field, no path)"
    if outcome.name == "scipy":
        return " (whole field)"
    cut = outcome.facts.get("corners cut", 0.0)
    return f" (cuts {cut:.0f} corners)" if cut else ""


def _grid_work(fits: Mask, start: Cell, goal: Cell) -> Work:
    path = shortest_grid_path(fits, start, goal)
    if path is None:
        raise ValueError("expected a way from corner to corner")
    return Work(once(lambda: shortest_grid_path(fits, start, goal)), {"length": path.length})


def _any_angle_rows(bench: Bench) -> list[Record]:
    """Return time of smooth plans, and how much longer than the shortest they are."""
    home = load_home("apartment", HOMES)
    config = RobotConfig()
    body, walk = config.body, config.walk
    room = body.radius + walk.clearance
    points = free_poses(apartment(), 12 if bench.is_quick else 40, room + 0.1)[:, :2].tolist()
    places = [(x, y) for x, y in points]
    pairs = list(zip(places[::2], places[1::2], strict=True))
    planner = PathPlanner(home.map, body.radius, walk.clearance, walk.tight_clearance)
    case = f"apartment, any-angle, {len(pairs)} pairs of points"
    [ours] = bench.compete([Local("ours", lambda: Work(_plans(planner, pairs)))])
    time = None if ours.rate is None else milliseconds(ours.rate)
    records = [Record(_TOPIC, case, "plan, mean", time, "ms", Better.LOWER, error=ours.error)]
    ways = ShortestWays(home.map.solid, home.frame, room)
    excess = [
        100.0 * (planner.plan(start, goal).length / ways.length(start, goal) - 1.0)
        for start, goal in pairs
    ]
    for which, value, aim in (
        ("worst pair", max(excess), _MOST_EXCESS),
        ("mean", float(np.mean(excess)), None),
    ):
        figure = f"longer than the shortest of a disc (visibility graph), {which}"
        records.append(Record(_TOPIC, case, figure, value, "%", Better.LOWER, aim))
    return records


def _plans(planner: PathPlanner, pairs: list[tuple[Point, Point]]) -> Callable[[], float]:
    forever = itertools.cycle(pairs)
    return once(lambda: planner.plan(*next(forever)))
