"""The database of runs: SQLite with a write-ahead log, so that several programs can write."""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from roomba.errors import RoombaError
from roomba.files.atomic import make_private
from roomba.files.journal import append_line, read_lines, write_lines
from roomba.files.lock import locked
from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_file import RunFileError, packed, unpacked
from roomba.history.run_rows import (
    ADDED,
    CHOSEN,
    COLUMNS,
    MIGRATIONS,
    Choice,
    KeptRun,
    insert,
    insert_row,
    row_of,
    select,
    transaction,
)
from roomba.history.totals import WeekTotals, weeks_of

if TYPE_CHECKING:
    from roomba.client.household import TotalsView

LAST: Final = "last"
"""In place of a run's number: the newest one."""
_NAME: Final = "runs.sqlite"
_JOURNAL: Final = "runs.journal"
_BUSY: Final = 10.0
"""s of wall time that one program waits for another one."""
_MOST_RECORDINGS: Final = 200
"""Recordings that are kept, of the newest runs; of older ones only the figures are kept."""
_LARGEST_NUMBER: Final = 2**63 - 1
"""The largest number of a run: SQLite has no larger integers."""

_UNUSABLE: Final = (
    sqlite3.Error,
    OSError,
    ValueError,
    TypeError,
    AttributeError,
    OverflowError,
    RunFileError,
)
"""What is raised when the disk refuses, or for values that are not as the database has them."""
_SUMS: Final = ("covered", "duration", "distance", "dirt", "energy")


class HistoryError(RoombaError):
    """The history cannot be used; the message names the file and says what to do."""


class History:
    """The runs in a folder; nothing is kept open between two calls, which may be of any thread.

    A database that is damaged is set aside under another name, which ``set_aside`` tells. A new one
    takes its place, or that of a missing one, with the figures of all runs from the journal beside
    it, but without recordings. All methods raise HistoryError.
    """

    def __init__(self, folder: Path) -> None:
        """Touch nothing yet."""
        self.path = folder / _NAME
        self._journal = folder / _JOURNAL
        self.set_aside: Path | None = None

    def add(self, figures: RunFigures, recording: RunRecording | None = None) -> int:
        """Keep a run, and return its number; it is on the disk then."""
        with self._opened() as database:
            content = None if recording is None else packed(figures, recording)
            with transaction(database):
                return self._insert(database, figures, content)

    def add_all(self, runs: Sequence[RunFigures]) -> int:
        """Keep many runs without recordings, all or none; return how many."""
        if not runs:
            return 0
        with self._opened() as database, transaction(database):
            for figures in runs:
                self._insert(database, figures)
        return len(runs)

    def configured(self, program: str, name: str) -> set[str]:
        """Return the values that the runs of a program have in their configurations."""
        with self._opened() as database:
            rows = database.execute(
                "SELECT DISTINCT configuration FROM runs WHERE program = ?", (program,)
            ).fetchall()
            values = [json.loads(text).get(name) for (text,) in rows]
        return {str(value) for value in values if value is not None}

    def runs(self, limit: int = 1000, home: str | None = None) -> list[KeptRun]:
        """Return the newest runs, the newest first; ``home`` chooses those of one home."""
        return self.chosen(Choice(home), limit)

    def chosen(self, choice: Choice, limit: int, before: int | None = None) -> list[KeptRun]:
        """Return the newest runs of a choice; with ``before`` only those older than that run."""
        older = "? IS NULL OR (began, id) < (SELECT began, id FROM runs WHERE id = ?)"
        which = f"{CHOSEN} AND ({older}) ORDER BY began DESC, id DESC LIMIT ?"
        with self._opened() as database:
            return select(database, which, (*choice.values, before, before, limit))

    def weeks(self, choice: Choice) -> list[WeekTotals]:
        """Return the totals by week over all runs of a choice, the newest first."""
        with self._opened() as database:
            return weeks_of(database, CHOSEN, choice.values)

    def totals(self, program: str) -> TotalsView:
        """Return the sums over all runs of a program; what is not known counts as nothing."""
        # Imported here, as it brings all of the household's plans, which keeping a run does not
        # need.
        from roomba.client.household import TotalsView

        sums = ", ".join(f"TOTAL({name})" for name in _SUMS)
        with self._opened() as database:
            row = database.execute(
                f"SELECT COUNT(*), {sums} FROM runs WHERE program = ?", (program,)
            ).fetchone()
        return TotalsView(*row)

    def run(self, number: int) -> KeptRun:
        """Return a run by its number."""
        found: list[KeptRun] = []
        if 0 < number <= _LARGEST_NUMBER:
            with self._opened() as database:
                found = select(database, "id = ?", (number,))
        if not found:
            newest = self.named(LAST).number
            raise HistoryError(
                f"{self.path}: expected the number of a run that was kept, the newest is {newest}, "
                f"got {number}; ./roomba report lists them"
            )
        return found[0]

    def named(self, word: str) -> KeptRun:
        """Return a run by its number in letters, or LAST for the newest one."""
        if word == LAST:
            runs = self.runs(limit=1)
            if not runs:
                raise HistoryError(
                    f"there are no runs yet in {self.path.parent}; ./roomba sim makes one, and "
                    "each clean of ./roomba play and run"
                )
            return runs[0]
        if not word.isdecimal():
            raise HistoryError(
                f"expected the number of a run, or {LAST}, got {word!r}; ./roomba report lists them"
            )
        return self.run(int(word))

    def recording(self, number: int) -> RunRecording:
        """Return what was recorded of a run."""
        with self._opened() as database:
            row = database.execute(
                "SELECT content FROM recordings WHERE run = ?", (number,)
            ).fetchone()
            if row is None:
                raise HistoryError(
                    f"{self.path}: expected a recording of run {number}, found none; they are kept "
                    f"of the newest {_MOST_RECORDINGS} runs"
                )
            return unpacked(row[0])[1]

    def _insert(
        self, database: sqlite3.Connection, figures: RunFigures, content: bytes | None = None
    ) -> int:
        """Keep a run in the database and in the journal; return its number."""
        number = insert(database, figures)
        append_line(self._journal, {"number": number, **row_of(figures)})
        if content is not None:
            database.execute("INSERT INTO recordings VALUES (?, ?)", (number, content))
            database.execute(
                "DELETE FROM recordings WHERE run NOT IN "
                "(SELECT run FROM recordings ORDER BY run DESC LIMIT ?)",
                (_MOST_RECORDINGS,),
            )
        return number

    @contextlib.contextmanager
    def _opened(self) -> Iterator[sqlite3.Connection]:
        """Open the database as the newest version; one that is damaged is set aside first."""
        try:
            self._prepare()
            with contextlib.closing(self._connect()) as database:
                yield database
        except _UNUSABLE as error:
            raise HistoryError(f"{self.path}: cannot be used: {error}") from error

    def _prepare(self) -> None:
        """Make the file, or bring it up to date; one process at a time."""
        make_private(self.path.parent)
        with locked(self.path.with_suffix(".lock"), _BUSY):
            if not self._is_there():
                self._make()
            try:
                self._bring_up_to_date()
            except sqlite3.DatabaseError as error:
                if isinstance(error, sqlite3.OperationalError):
                    raise
                self._set_aside()
                self._make()
                self._bring_up_to_date()
            if not self._journal.exists():
                self._begin_journal()

    def _connect(self) -> sqlite3.Connection:
        return _connected(self.path)

    def _is_there(self) -> bool:
        """Whether there is a file that is not empty."""
        try:
            with open(os.open(self.path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW), "rb") as file:
                return file.seek(0, os.SEEK_END) > 0
        except FileNotFoundError:
            return False

    def _make(self) -> None:
        """Make a database with the figures of the journal; it gets its name once it is filled."""
        new = self.path.with_name(f"{_NAME}.new")
        # SQLite would take files that are left of another database for its own.
        for left in (new, *_beside(new), *_beside(self.path)):
            left.unlink(missing_ok=True)
        # SQLite gives its log the mode of the file.
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW
        os.close(os.open(new, flags, 0o600))
        with contextlib.closing(_connected(new)) as database:
            _migrate(database, 0)
            self._restore(database)
        new.replace(self.path)

    def _bring_up_to_date(self) -> None:
        with contextlib.closing(self._connect()) as database:
            database.execute("PRAGMA journal_mode = WAL")
            version = int(database.execute("PRAGMA user_version").fetchone()[0])
            if version > len(MIGRATIONS):
                raise HistoryError(
                    f"{self.path}: expected version {len(MIGRATIONS)} or older, got {version}, "
                    "which a newer program wrote; use that one, or move the file away"
                )
            if database.execute("PRAGMA quick_check(1)").fetchone()[0] != "ok":
                raise sqlite3.DatabaseError("the check of its pages failed")
            _migrate(database, version)

    def _begin_journal(self) -> None:
        """Write the figures of a database that an older program made."""
        with contextlib.closing(self._connect()) as database:
            runs = select(database, "TRUE ORDER BY id", ())
        write_lines(self._journal, ({"number": run.number, **row_of(run.figures)} for run in runs))

    def _restore(self, database: sqlite3.Connection) -> None:
        """Fill a new database with the figures of the journal."""
        # Where a number is there twice, the first writer was killed before the database had its
        # run.
        rows = {row.pop("number", None): ADDED | row for row in read_lines(self._journal)}
        with transaction(database):
            for number, row in rows.items():
                if isinstance(number, int) and set(row) == {*COLUMNS, "missed"}:
                    insert_row(database, row, number)

    def _set_aside(self) -> None:
        stamp = time.strftime("%Y%m%d-%H%M%S")
        aside = self.path.with_name(f"{_NAME}.damaged-{stamp}-{os.getpid()}")
        self.path.replace(aside)
        for one, other in zip(_beside(self.path), _beside(aside), strict=True):
            with contextlib.suppress(FileNotFoundError):
                one.replace(other)
        self.set_aside = aside


def _beside(path: Path) -> list[Path]:
    """Return the files that SQLite may have beside a database."""
    return [path.with_name(path.name + end) for end in ("-wal", "-shm", "-journal")]


def _connected(path: Path) -> sqlite3.Connection:
    database = sqlite3.connect(path, timeout=_BUSY, isolation_level=None)
    database.execute("PRAGMA foreign_keys = ON")
    database.execute("PRAGMA synchronous = FULL")
    return database


def _migrate(database: sqlite3.Connection, version: int) -> None:
    """Bring a database of a version to the newest one."""
    for step in range(version, len(MIGRATIONS)):
        script = f"BEGIN;{MIGRATIONS[step]};PRAGMA user_version = {step + 1};COMMIT;"
        database.executescript(script)
