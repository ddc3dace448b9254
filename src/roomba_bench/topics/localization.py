"""How well the robot knows where it is: on long drives, in changed homes, and when carried away."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roomba.cores import usable_cores
from roomba_bench.bench import Bench
from roomba_bench.localization import drive as drives
from roomba_bench.localization import kidnaps as kidnapped
from roomba_bench.localization.drive import Drive, drive
from roomba_bench.localization.kidnaps import Manner, Try, kidnap
from roomba_bench.localization.peers import Followed, ScannedDrive, follow, match_row
from roomba_bench.localization.plot import plot_drive, plot_spread
from roomba_bench.localization.rows import broken_row, drive_rows, kidnap_rows
from roomba_bench.record import Record
from roomba_bench.workers import Workers

_SHIPPED = ("flat", "studio", "family", "apartment", "empty", "lshape", "hall")
_CHANGED = ("flat", "apartment")
_KIDNAPPED = ("flat", "apartment", "family", "empty")
_DRAWN = "flat"
"""The home whose drive is drawn, and on whose scans the time of a match is measured."""
_BOUNDLESS = "hall"
"""A home where the lidar mostly sees nothing; it is left out of the errors over all homes."""


@dataclass(frozen=True)
class Extent:
    """How much is measured: drives per home, s of each, s that peers follow one, tries.

    ``together`` tries are made one after the other; the next ones start anew, perhaps in another
    process.
    """

    drives: int = 10
    seconds: float = 2100.0
    followed: float = 600.0
    tries: int = 100
    tries_on_maps: int = 25
    together: int = 25


THOROUGH = Extent()
QUICK = Extent(1, 300.0, 300.0, 10, 5, 10)


@dataclass(frozen=True)
class Homes:
    """Homes of a folder, "" for those shipped, and what is done in which of them."""

    folder: str
    names: tuple[str, ...]
    changed: tuple[str, ...]
    kidnapped: tuple[str, ...]
    manners: tuple[Manner, ...]
    tries: int

    def title(self, name: str) -> str:
        """Return a home's name in the table."""
        return f"map {name}" if self.folder else name


@dataclass(frozen=True, eq=False)
class _Begun:
    """What is under way: by case, in the order of the table."""

    scans: dict[str, Path]
    drives: dict[str, list[Future[Drive]]]
    kidnaps: dict[tuple[str, Manner], list[Future[list[Try]]]]


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    return measured(bench, QUICK if bench.is_quick else THOROUGH)


def measured(bench: Bench, extent: Extent, homes: Sequence[Homes] | None = None) -> list[Record]:
    """Return the rows for some homes; by default the shipped ones and those of the maps."""
    at_once = usable_cores()
    records = []
    with Workers() as pool:
        for group in homes or (*_shipped(extent), *_of_maps(bench, extent)):
            records += _rows(bench, group, _begin(bench, pool, group, extent), extent, at_once)
    return [*records, *_match_rows(bench)]


def _shipped(extent: Extent) -> list[Homes]:
    return [Homes("", _SHIPPED, _CHANGED, _KIDNAPPED, tuple(Manner), extent.tries)]


def _of_maps(bench: Bench, extent: Extent) -> list[Homes]:
    if bench.maps is None:
        return []
    names = tuple(path.stem for path in sorted(bench.maps.glob("*.yaml")))
    folder = str(bench.maps.resolve())
    return [Homes(folder, names, (), names, (Manner.LIFTED,), extent.tries_on_maps)]


def _begin(bench: Bench, pool: Executor, homes: Homes, extent: Extent) -> _Begun:
    """Submit all drives, the longest tasks, and then all kidnappings."""
    begun = _Begun({}, {}, {})
    minutes = f"{extent.drives} x {extent.seconds / 60.0:g} min"
    for name in homes.names:
        begun.scans[name] = bench.folder / f"scans-{homes.title(name)}.npz"
        tasks = [
            drives.Task(
                name,
                seed,
                extent.seconds,
                homes.folder,
                scans=None if seed else begun.scans[name],
                scan_seconds=extent.followed,
            )
            for seed in range(extent.drives)
        ]
        title = f"{homes.title(name)}, {minutes}"
        begun.drives[title] = [pool.submit(drive, task) for task in tasks]
    for name in homes.changed:
        tasks = [
            drives.Task(name, seed, extent.seconds, homes.folder, is_changed=True)
            for seed in range(extent.drives)
        ]
        title = f"{homes.title(name)}, changed, {minutes}"
        begun.drives[title] = [pool.submit(drive, task) for task in tasks]
    for name in homes.kidnapped:
        for manner in homes.manners:
            together = min(extent.together, homes.tries)
            begun.kidnaps[homes.title(name), manner] = [
                pool.submit(
                    kidnap,
                    kidnapped.Task(name, manner, seed, together, homes.folder),
                )
                for seed in range(homes.tries // together)
            ]
    return begun


def _rows(bench: Bench, homes: Homes, begun: _Begun, extent: Extent, at_once: int) -> list[Record]:
    records: list[Record] = []
    drives: dict[str, list[Drive]] = {}
    for case, futures in begun.drives.items():
        try:
            drives[case] = [future.result() for future in futures]
            records += drive_rows(case, drives[case])
        except Exception as error:
            records.append(broken_row(case, error))
        bench.say(case)
    kidnaps: list[Record] = []
    for (case, manner), tries in begun.kidnaps.items():
        try:
            done = [each for future in tries for each in future.result()]
            kidnaps += kidnap_rows(case, manner, done)
        except Exception as error:
            kidnaps.append(broken_row(f"{case}, {manner.value}", error))
        bench.say(f"{case}, {manner.value}")
    scanned = [
        ScannedDrive(name, homes.folder, path)
        for name, path in begun.scans.items()
        if path.exists()
    ]
    bench.say("peers on the same scans")
    followed = follow(bench, scanned, at_once)
    for one, each in zip(scanned, followed, strict=True):
        minutes = f"the first {extent.followed / 60.0:g} min of one drive, at each scan"
        records += each.rows(f"{homes.title(one.home)}, {minutes}")
    _draw(bench, homes, drives, dict(zip([one.home for one in scanned], followed, strict=True)))
    return records + kidnaps


def _draw(
    bench: Bench, homes: Homes, drives: dict[str, list[Drive]], followed: dict[str, Followed]
) -> None:
    """Write the pictures beside that of the bars."""
    stem = "localization-maps" if homes.folder else "localization"
    if _DRAWN in followed:
        plot_drive(bench.pictures / f"{stem}-drive.png", f"{_DRAWN}, one drive", followed[_DRAWN])
    ours = {
        homes.title(one.home): np.concatenate([each.ours for each in made])
        for made in drives.values()
        for one in [made[0].task]
        if not one.is_changed
    }
    bounded = [each for name, each in followed.items() if name != _BOUNDLESS]
    if ours and bounded:
        plot_spread(bench.pictures / f"{stem}-errors.png", ours, bounded)


def _match_rows(bench: Bench) -> list[Record]:
    """Time a match, now that nothing else runs."""
    scans = bench.folder / f"scans-{_DRAWN}.npz"
    bench.say("one match")
    return [match_row(bench, ScannedDrive(_DRAWN, "", scans))] if scans.exists() else []
