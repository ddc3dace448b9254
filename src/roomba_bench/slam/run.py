"""One recorded drive: mapped, timed, and judged by its relations if there are some."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.map.drive.mapped import MappedDrive, mapped_drive
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.packed import plain_name
from roomba_bench.slam.localized import (
    Fitting,
    Followed,
    fitting_on,
    followed_on_own_map,
    map_beside,
)
from roomba_bench.slam.relations import Errors, errors, load_relations, relations_beside

_LOGS: Final = (".bag", ".db3", ".mcap", ".log", ".clf")


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """A drive that was mapped; without relations beside it there are no errors.

    ``seconds`` is what the mapper took of one core, the least of some rounds. ``followed`` is the
    same drive on its own map, and ``fitting`` on one of another day, if there is one beside it.
    """

    name: str
    drive: MappedDrive
    ours: Errors | None
    by_odometry: Errors | None
    seconds: float
    followed: tuple[Followed, ...] = ()
    fitting: Fitting | None = None

    @property
    def times_real_time(self) -> float:
        """Time of the drive by what the mapper took of one core."""
        return self.drive.replay.elapsed / max(self.seconds, 1e-9)


def logs_in(folder: Path) -> Iterator[Path]:
    """Yield the logs of a folder: bags, packed or not, folders that are bags, and CARMEN logs."""
    for path in sorted(folder.iterdir()):
        is_bag = (path / "metadata.yaml").is_file()
        if is_bag or Path(plain_name(path)).suffix.lower() in _LOGS:
            yield path


def name_of(log: Path) -> str:
    """Return the name of a log without suffixes."""
    return log.name if log.is_dir() else Path(plain_name(log)).stem


def judged(log: Path, rounds: int) -> Judged:
    """Map a log, of which each round makes the same map; the first one may have to compile.

    Raises RoombaError for a log that cannot be read, and ValueError for its relations.
    """
    relations = relations_beside(log)
    true = None if relations is None else load_relations(relations)
    drives = [mapped_drive([log], Wanted(), lambda share, words: None) for _ in range(rounds)]
    drive, seconds = drives[-1], min(each.replay.seconds for each in drives)
    ours = by_odometry = None
    if true is not None:
        ours, by_odometry = errors(drive.trajectory, true), errors(drive.replay.by_odometry, true)
    other_day = map_beside(log, name_of(log))
    return Judged(
        name_of(log),
        drive,
        ours,
        by_odometry,
        seconds,
        tuple(followed_on_own_map(log, drive)),
        None if other_day is None else fitting_on(log, other_day),
    )
