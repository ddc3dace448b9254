"""The table's rows about explorations, loops and cleans."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from roomba.commands.map.runs import Drawn
from roomba_bench.mapping.explore import Cleaned, Explored
from roomba_bench.mapping.loop import WAY, Looped
from roomba_bench.record import Better, PeerFigure, Record

TOPIC = "mapping"
BLIND: Final = "wheels and gyro alone"
TRUE_MAP: Final = "by the true map"
EXPLORED_FIRST: Final = "explored first"
WALLS_AIM, FLOOR_AIM = 97.0, 97.0
"""%."""
TIME_AIM: Final = {"flat": 360.0}
"""s of robot time, for homes with such an aim."""
LOOP_AIM: Final = 50.0
"""mm."""
CORE_AIM: Final = 20.0
"""%."""
SPEED_AIM: Final = 200.0
"""s of robot time per second of a core."""
CLEAN_AIM: Final = 99.0
"""%."""


def explored_rows(case: str, done: Sequence[Explored], home: str) -> list[Record]:
    """Return the rows of explorations of one home; of the seeds the worst counts."""
    rows = [
        _worst(case, done, "walls within 5 cm", "%", Better.HIGHER, WALLS_AIM, _walls),
        _worst(case, done, "free floor, IoU", "%", Better.HIGHER, FLOOR_AIM, _floor),
        _worst(case, done, "walls mapped twice", "cells", Better.LOWER, 0.0, _doubled),
        _worst(case, done, "robot's place, largest error", "mm", Better.LOWER, None, _largest),
        _worst(case, done, "map turned by", "degrees", Better.LOWER, None, _turned),
    ]
    return [
        *rows,
        _row(
            case,
            "robot time, longest",
            max(each.seconds for each in done),
            "s",
            Better.LOWER,
            TIME_AIM.get(home),
        ),
        _row(case, "way, longest", max(each.way for each in done), "m", Better.LOWER),
        _row(case, "hits, most", max(each.hits for each in done), "", Better.LOWER),
        _row(
            case,
            "docked, and says that it saw all",
            100.0 * sum(each.is_done for each in done) / len(done),
            "% of the seeds",
            Better.HIGHER,
            100.0,
        ),
    ]


def loop_rows(loops: Sequence[Looped]) -> list[Record]:
    """Return the rows of the ring; of the seeds the worst counts."""
    case = f"ring of {WAY:.0f} m, driven around once, {_seeds(len(loops))}"
    end = 1e3 * max(each.end for each in loops)
    before = 1e3 * max(each.end_before for each in loops)
    blind = PeerFigure(BLIND, value=1e3 * max(each.end_blind for each in loops))
    walls = 100.0 * min(each.error.walls for each in loops)
    blind_walls = PeerFigure(BLIND, value=100.0 * min(each.error_blind.walls for each in loops))
    doubled = max(each.error.doubled for each in loops)
    blind_doubled = PeerFigure(BLIND, value=max(each.error_blind.doubled for each in loops))
    return [
        _row(case, "end off its place", end, "mm", Better.LOWER, LOOP_AIM, (blind,)),
        _row(case, "end off its place, before the map is finished", before, "mm", Better.LOWER),
        _row(case, "walls within 5 cm", walls, "%", Better.HIGHER, None, (blind_walls,)),
        _row(case, "walls mapped twice", doubled, "cells", Better.LOWER, 0.0, (blind_doubled,)),
    ]


def core_row(home: str, core: float) -> Record:
    """Return the row of the share of a core, 0..1, that mapping takes in real time."""
    case = f"{home}, in real time, scans of 10 Hz"
    return _row(case, "one core, while it maps", 100.0 * core, "%", Better.LOWER, CORE_AIM)


def speed_row(home: str, folder: str, speed: float) -> Record:
    """Return the row of how many s of robot time an exploration takes per second of a core."""
    unit = "robot seconds per second of a core"
    case = f"{'map ' if folder else ''}{home}, headless"
    return _row(case, "whole exploration", speed, unit, Better.HIGHER, SPEED_AIM)


def clean_rows(home: str, done: Sequence[Cleaned], by_truth: Sequence[Cleaned]) -> list[Record]:
    """Return the rows of cleans by maps that the robot made, beside those by the true one."""
    case = f"{home}, cleaned by its own map, {_seeds(len(done))}"
    return [_share_row(case, done, TRUE_MAP, by_truth), _home_row(case, done, TRUE_MAP, by_truth)]


def newcomer_rows(
    home: str, done: Sequence[Cleaned], explored: Sequence[Explored], later: Sequence[Cleaned]
) -> list[Record]:
    """Return the rows of cleans that began before there was a map.

    The other figure of each is for exploring first, and then cleaning by that map.
    """
    case = f"{home}, cleaned while it is mapped, {_seeds(len(done))}"
    first = (PeerFigure(EXPLORED_FIRST, value=_minutes(explored) + _minutes(later)),)
    return [
        _share_row(case, done, EXPLORED_FIRST, later),
        _row(case, "robot time, mean", _minutes(done), "min", Better.LOWER, None, first),
        _home_row(case, done, EXPLORED_FIRST, later),
    ]


def _share_row(case: str, done: Sequence[Cleaned], peer: str, beside: Sequence[Cleaned]) -> Record:
    ours, theirs = (100.0 * min(each.share for each in cleaned) for cleaned in (done, beside))
    figure, peers = "coverage of the true floor, least", (PeerFigure(peer, value=theirs),)
    return _row(case, figure, ours, "%", Better.HIGHER, CLEAN_AIM, peers)


def _home_row(case: str, done: Sequence[Cleaned], peer: str, beside: Sequence[Cleaned]) -> Record:
    unit, peers = "% of the seeds", (PeerFigure(peer, value=_done(beside)),)
    return _row(case, "home and done", _done(done), unit, Better.HIGHER, 100.0, peers)


def _minutes(done: Sequence[Explored] | Sequence[Cleaned]) -> float:
    """Return the mean duration, min."""
    return float(np.mean([each.seconds for each in done])) / 60.0


def broken_row(case: str, error: Exception) -> Record:
    """Return a row for what could not be measured."""
    reason = f"{type(error).__name__}: {error}"
    return Record(TOPIC, case, "everything", None, "", Better.LOWER, error=reason)


def seeds(home: str, folder: str, count: int) -> str:
    """Return a case's name in the table."""
    return f"{'map ' if folder else ''}{home}, {_seeds(count)}"


def _seeds(count: int) -> str:
    return "1 seed" if count == 1 else f"{count} seeds"


def _worst(
    case: str,
    done: Sequence[Explored],
    figure: str,
    unit: str,
    better: Better,
    aim: float | None,
    of: Callable[[Drawn], float],
) -> Record:
    """Return a row with the worst figure of some explorations, and the worst of dead reckoning."""
    worst = max if better is Better.LOWER else min
    peer = PeerFigure(BLIND, value=worst(of(each.blind) for each in done))
    ours = worst(of(each.made) for each in done)
    return _row(case, figure, ours, unit, better, aim, (peer,))


def _row(
    case: str,
    figure: str,
    value: float,
    unit: str,
    better: Better,
    aim: float | None = None,
    peers: tuple[PeerFigure, ...] = (),
) -> Record:
    return Record(TOPIC, case, figure, float(value), unit, better, aim, peers)


def _walls(drawn: Drawn) -> float:
    return 100.0 * drawn.error.walls


def _floor(drawn: Drawn) -> float:
    return 100.0 * drawn.error.floor


def _doubled(drawn: Drawn) -> float:
    return float(drawn.error.doubled)


def _largest(drawn: Drawn) -> float:
    return 1e3 * drawn.largest


def _turned(drawn: Drawn) -> float:
    return abs(math.degrees(drawn.error.rotation))


def _done(cleans: Sequence[Cleaned]) -> float:
    return 100.0 * sum(each.is_home_and_done for each in cleans) / len(cleans)
