"""Recorded drives of real robots: how true their maps are, and how fast they are made."""

from __future__ import annotations

from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.contestants import REPOSITORY
from benchmarks.record import Record
from benchmarks.slam.picture import write_picture
from benchmarks.slam.rows import broken_row, rows_of
from benchmarks.slam.run import judged, logs_in, name_of
from roomba.commands.map.warm import warm_up
from roomba.errors import RoombaError

_QUICK, _THOROUGH = 1, 2
"""Rounds of what is timed."""
_PICTURES = REPOSITORY / "benchmarks" / "results"


def measure(bench: Bench) -> list[Record]:
    """Return the rows of all logs of the folder, and write a picture of each."""
    if bench.logs is None:
        bench.say("slam: the project has no recorded drives of its own; --logs FOLDER names some")
        return []
    return measured(bench, bench.logs, _PICTURES)


def measured(bench: Bench, logs: Path, pictures: Path) -> list[Record]:
    """Return the rows of all logs of a folder; the pictures go to another one."""
    warm_up()
    pictures.mkdir(parents=True, exist_ok=True)
    rows: list[Record] = []
    for log in logs_in(logs):
        bench.say(f"slam: {name_of(log)}")
        rows += _rows(
            log, _QUICK if bench.is_quick else _THOROUGH, pictures / f"slam-{name_of(log)}.png"
        )
    return rows


def _rows(log: Path, rounds: int, picture: Path) -> list[Record]:
    """Return the rows of a log; one that cannot be read has one with the reason."""
    try:
        result = judged(log, rounds)
    except (RoombaError, ValueError, OSError) as error:
        return [broken_row(name_of(log), error)]
    write_picture(picture, result)
    return list(rows_of(result))
