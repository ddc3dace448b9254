"""Runs as rows of a database."""

from __future__ import annotations

import math
import os
import sqlite3
from dataclasses import replace

import pytest
from unit.history.made import made_figures

from roomba.history.run_rows import ADDED, COLUMNS, MIGRATIONS, insert, row_of, select


@pytest.fixture
def database() -> sqlite3.Connection:
    made = sqlite3.connect(":memory:")
    for script in MIGRATIONS:
        made.executescript(script)
    return made


def test_what_is_put_in_comes_out_again(database: sqlite3.Connection) -> None:
    figures = made_figures()
    assert insert(database, figures) == 1
    assert insert(database, replace(figures, kind="explore", mapped=20.5)) == 2
    first, second = select(database, "TRUE ORDER BY id", ())
    assert (first.number, first.is_recorded) == (1, False)
    # What is not known equals nothing.
    assert math.isnan(first.figures.energy)
    known = replace(first.figures, energy=0.0, mapped=0.0)
    assert known == replace(figures, energy=0.0, mapped=0.0)
    assert (second.figures.kind, second.figures.mapped) == ("explore", 20.5)
    assert [run.number for run in select(database, "kind = ?", ("explore",))] == [2]


def test_a_home_whose_name_is_no_utf_8_is_kept(database: sqlite3.Connection) -> None:
    made = made_figures()
    source = replace(made.source, home=os.fsdecode(b"K\xfcche"), repeat=os.fsdecode(b"sim \xfc"))
    insert(database, replace(made, source=source))
    [run] = select(database, "TRUE", ())
    assert (run.figures.source.home, run.figures.source.repeat) == ("K?che", "sim ?")


def test_a_reason_of_a_newer_program_is_left_out(database: sqlite3.Connection) -> None:
    insert(database, made_figures())
    database.execute("UPDATE runs SET open_edges = '[[1.0, 2.0, 3.0, \"NEW\"]]'")
    [run] = select(database, "TRUE", ())
    assert run.figures.open_edges == ()


def test_a_row_has_all_columns_and_what_was_added_is_one_of_them() -> None:
    row = row_of(made_figures())
    assert set(row) == {*COLUMNS, "missed"}
    assert set(ADDED) < set(COLUMNS)
    assert row["energy"] is None
