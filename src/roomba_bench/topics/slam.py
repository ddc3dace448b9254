"""Recorded drives of real robots: how true their maps are, and how fast they are made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from roomba.commands.map.warm import warm_up
from roomba.errors import RoombaError
from roomba_bench.bench import Bench
from roomba_bench.record import Record
from roomba_bench.slam.covariance_picture import simulated_squares, write_covariances
from roomba_bench.slam.picture import write_picture
from roomba_bench.slam.rows import broken_row, rows_of
from roomba_bench.slam.run import judged, logs_in, name_of

_QUICK, _THOROUGH = 1, 2
"""Rounds of what is timed."""
_QUICK_SECONDS, _SECONDS = 10.0, 300.0
"""s; of each simulated drive that is drawn beside the recorded ones."""


def measure(bench: Bench) -> list[Record]:
    """Return the rows of all logs of the folder, and write a picture of each."""
    if bench.logs is None:
        bench.say("slam: the project has no recorded drives of its own; --logs FOLDER names some")
        return []
    return measured(bench, bench.logs, bench.pictures)


def measured(bench: Bench, logs: Path, pictures: Path) -> list[Record]:
    """Return the rows of all logs of a folder; the pictures go to another one."""
    warm_up()
    pictures.mkdir(parents=True, exist_ok=True)
    rows: list[Record] = []
    squares: dict[str, NDArray[np.float64]] = {}
    for log in logs_in(logs):
        bench.say(f"slam: {name_of(log)}")
        try:
            result = judged(log, _QUICK if bench.is_quick else _THOROUGH)
        except (RoombaError, ValueError, OSError) as error:
            rows.append(broken_row(name_of(log), error))
            continue
        write_picture(pictures / f"slam-{name_of(log)}.png", result)
        rows += rows_of(result)
        squares |= {
            f"{result.name}, {each.cells}": each.squares for each in result.followed if each.is_told
        }
    bench.say("slam: covariances in simulation")
    simulated = simulated_squares(_QUICK_SECONDS if bench.is_quick else _SECONDS)
    write_covariances(pictures / "slam-covariances.png", squares | simulated)
    return rows
