"""Runs as rows of the database: its tables, and figures that are put in and taken out."""

from __future__ import annotations

import contextlib
import json
import math
import sqlite3
from collections.abc import Iterator
from dataclasses import asdict, astuple, dataclass
from typing import Any, Final

from roomba.client.protocol import MissedFloor
from roomba.history.run import CAMPAIGN, RunFigures, RunSource
from roomba.time_spent import TimeSpent
from roomba.vocabulary import EdgeReason, OpenEdge

MIGRATIONS: Final = (
    """
    CREATE TABLE runs (
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        program TEXT NOT NULL, home TEXT NOT NULL, seed INTEGER, repeat TEXT NOT NULL,
        configuration TEXT NOT NULL, kind TEXT NOT NULL, began REAL NOT NULL,
        outcome TEXT NOT NULL, message TEXT NOT NULL, duration REAL, covered REAL, wanted REAL,
        distance REAL, turning REAL, dirt REAL, energy REAL
    );
    CREATE INDEX runs_by_time ON runs (began);
    CREATE TABLE missed (
        run INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE,
        area REAL NOT NULL, x REAL NOT NULL, y REAL NOT NULL, room TEXT NOT NULL,
        reason TEXT NOT NULL
    );
    CREATE INDEX missed_by_run ON missed (run);
    """,
    """
    CREATE TABLE recordings (
        run INTEGER PRIMARY KEY REFERENCES runs (id) ON DELETE CASCADE, content BLOB NOT NULL
    );
    """,
    """
    ALTER TABLE runs ADD COLUMN times TEXT NOT NULL DEFAULT '{}';
    """,
    """
    ALTER TABLE runs ADD COLUMN mapped REAL;
    ALTER TABLE runs ADD COLUMN open_edges TEXT NOT NULL DEFAULT '[]';
    """,
    """
    ALTER TABLE missed ADD COLUMN code TEXT NOT NULL DEFAULT '';
    """,
)
"""Scripts of SQL: each makes a version of the schema of the one before, the first of nothing."""

COLUMNS: Final = (
    "program", "home", "seed", "repeat", "configuration", "kind", "began", "outcome", "message",
    "duration", "covered", "wanted", "distance", "turning", "dirt", "energy",
    "times", "mapped", "open_edges",
)  # fmt: skip
ADDED: Final = {"times": "{}", "mapped": None, "open_edges": "[]"}
"""Columns that rows of older journals do not have, with the values to take for them."""
_NUMBERS: Final = (
    "duration", "covered", "wanted", "distance", "turning", "dirt", "energy", "mapped",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class KeptRun:
    """A run of the history by its number; ``is_recorded`` whether it can be looked at again."""

    number: int
    figures: RunFigures
    is_recorded: bool


def insert(database: sqlite3.Connection, figures: RunFigures) -> int:
    """Keep a run by the next number; return that."""
    return insert_row(database, row_of(figures))


def row_of(figures: RunFigures) -> dict[str, Any]:
    """Return the columns of a run, with its missed floor as rows of their own.

    Raises ValueError for numbers that are not finite, and TypeError for values that are not plain.
    """
    source = figures.source
    return {
        "program": source.program,
        "home": _legible(source.home),
        "seed": source.seed,
        "repeat": _legible(source.repeat),
        "configuration": _text(dict(source.configuration)),
        "kind": figures.kind,
        "began": figures.began,
        "outcome": figures.outcome,
        "message": figures.message,
        "times": _text(asdict(figures.times)),
        "open_edges": _text(
            [[edge.length, edge.x, edge.y, edge.reason.name] for edge in figures.open_edges]
        ),
        **{name: _known(getattr(figures, name)) for name in _NUMBERS},
        "missed": [
            [miss.area, miss.x, miss.y, miss.room, miss.reason, miss.code]
            for miss in figures.missed
        ],
    }


def insert_row(database: sqlite3.Connection, row: dict[str, Any], number: int | None = None) -> int:
    """Keep the columns of a run, by its number or the next one; return the number."""
    names = ", ".join(COLUMNS)
    places = ", ".join(f":{name}" for name in COLUMNS)
    values = {name: row[name] for name in COLUMNS} | {"id": number}
    added = database.execute(f"INSERT INTO runs (id, {names}) VALUES (:id, {places})", values)
    given = added.lastrowid
    assert given is not None
    missed = [(given, *astuple(MissedFloor(*miss))) for miss in row["missed"]]
    database.executemany("INSERT INTO missed VALUES (?, ?, ?, ?, ?, ?, ?)", missed)
    return given


def _legible(name: str) -> str:
    """Return a text with ? for what is no character, as in names of files that are no UTF-8."""
    return name.encode(errors="replace").decode()


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True, allow_nan=False)


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


@dataclass(frozen=True, slots=True)
class Choice:
    """Runs of one home and of one program, None: of all; ``campaigns``: those of campaigns, too."""

    home: str | None = None
    program: str | None = None
    campaigns: bool = True

    @property
    def values(self) -> tuple[Any, ...]:
        """What stands in the places of :data:`CHOSEN`."""
        home = None if self.home is None else _legible(self.home)
        return home, home, self.program, self.program, self.campaigns, CAMPAIGN


CHOSEN: Final = "(? IS NULL OR home = ?) AND (? IS NULL OR program = ?) AND (? OR program != ?)"
"""The condition of SQL that is true of the runs of a choice."""


def select(database: sqlite3.Connection, which: str, values: tuple[Any, ...]) -> list[KeptRun]:
    """Return the runs of which a condition of SQL is true, as its order says."""
    names = ", ".join(COLUMNS)
    rows = database.execute(
        f"SELECT id, id IN (SELECT run FROM recordings), {names} FROM runs WHERE {which}", values
    ).fetchall()
    return [
        KeptRun(
            row[0], _figures_of(database, row[0], dict(zip(COLUMNS, row[2:], strict=True))), row[1]
        )
        for row in rows
    ]


def _figures_of(database: sqlite3.Connection, number: int, row: dict[str, Any]) -> RunFigures:
    missed = database.execute(
        "SELECT area, x, y, room, reason, code FROM missed WHERE run = ? ORDER BY area DESC",
        (number,),
    )
    source = RunSource(
        row["program"], row["home"], row["seed"], row["repeat"], json.loads(row["configuration"])
    )
    return RunFigures(
        source,
        row["kind"],
        row["began"],
        row["outcome"],
        row["message"],
        **{name: math.nan if row[name] is None else row[name] for name in _NUMBERS},
        missed=tuple(MissedFloor(*miss) for miss in missed),
        times=TimeSpent(**json.loads(row["times"])),
        open_edges=_edges_of(json.loads(row["open_edges"])),
    )


def _edges_of(rows: list[tuple[float, float, float, str]]) -> tuple[OpenEdge, ...]:
    """Return open edges; without those whose reason only a newer program knows."""
    return tuple(
        OpenEdge(length, x, y, EdgeReason[reason])
        for length, x, y, reason in rows
        if reason in EdgeReason.__members__
    )


@contextlib.contextmanager
def transaction(database: sqlite3.Connection) -> Iterator[None]:
    """Keep all that is changed in the block, or nothing of it if the block raises."""
    database.execute("BEGIN IMMEDIATE")
    try:
        yield
    except BaseException:
        database.execute("ROLLBACK")
        raise
    database.execute("COMMIT")
