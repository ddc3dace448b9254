"""The results of a campaign in its folder: each is on the disk once it is stored."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from roomba.commands.campaign.running.runs import CampaignRun
from roomba.commands.campaign.running.work import RunEnd
from roomba.commands.options import UsageError
from roomba.files.journal import append_line, read_lines
from roomba.files.lock import try_to_lock

Row = dict[str, Any]
"""A run: key, home, seed, variant, figures (None without), failure, where, began."""

_JOURNAL: Final = "results.journal"
_LOCK: Final = "lock"


class ResultStore:
    """The rows of a campaign, by their keys; made by :func:`opened_store`."""

    def __init__(self, folder: Path) -> None:
        """Read what is there; raises OSError."""
        self._journal = folder / _JOURNAL
        self._rows: dict[str, Row] = {}
        for row in read_lines(self._journal):
            self._rows.setdefault(str(row.get("key")), row)

    def __contains__(self, key: object) -> bool:
        """Whether a run is stored."""
        return key in self._rows

    def __len__(self) -> int:
        """How many runs are stored, also of other states of program and file."""
        return len(self._rows)

    def add(self, run: CampaignRun, end: RunEnd) -> None:
        """Store what came of a run; raises OSError when the disk refuses."""
        row: Row = {
            "key": run.key,
            "home": run.home,
            "seed": run.seed,
            "variant": run.variant,
            "figures": None if end.figures is None else end.figures.as_json(),
            "failure": end.failure,
            "where": end.where,
            "began": end.began,
        }
        append_line(self._journal, row)
        self._rows[run.key] = row

    def rows_of(self, runs: Iterable[CampaignRun]) -> list[Row]:
        """Return the rows of those runs that are stored, with the campaign's present names."""
        return [
            self._rows[run.key] | {"home": run.home, "variant": run.variant}
            for run in runs
            if run.key in self._rows
        ]


@contextlib.contextmanager
def opened_store(folder: Path) -> Iterator[ResultStore]:
    """Open the results in a folder, made if needed; raises UsageError if it is in use."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / _LOCK).open("w") as lock:
        if not try_to_lock(lock.fileno()):
            raise UsageError(
                f"--out: another campaign writes into {folder}; wait for its end, or choose "
                "another folder"
            )
        yield ResultStore(folder)
