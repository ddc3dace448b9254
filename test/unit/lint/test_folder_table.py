"""The tables of folders are read, and compared with the packages, as their page says."""

from pathlib import Path

import grimp
import pytest

from lint.folder_table import Row, TableError, problems, rows_of
from roomba.commands.pictures.import_graph import Import, folders_in, imports_in

DESIGN = Path(__file__).parents[3] / "docs" / "design.md"

PAGE = """
### `src/roomba_ros`

| folder | what it is | may import |
|---|---|---|
| `nodes` | nodes | `roomba/brain/*` |

### `src/roomba`

| folder | what it is | may import |
|---|---|---|
| `brain/mission` | errands | `brain/maps` |
| `brain/maps` | maps | — |
| `errors.py`, `grid.py` | shared words | — |

## Times
"""
ROWS = [
    Row(("roomba_ros.nodes",), ("roomba.brain.*",)),
    Row(("roomba.brain.mission",), ("roomba.brain.maps",)),
    Row(("roomba.brain.maps",), ()),
    Row(("roomba.errors", "roomba.grid"), ()),
]
FOLDERS = [folder for row in ROWS for folder in row.folders]


def one_import(importer: str, imported: str) -> Import:
    return Import(f"{importer}.a", f"{imported}.b", importer, imported)


def test_rows_are_read_from_the_tables_of_both_packages() -> None:
    assert rows_of(PAGE) == ROWS


def test_a_page_without_a_table_is_refused() -> None:
    with pytest.raises(TableError, match="src/roomba`"):
        rows_of(PAGE.replace("### `src/roomba`\n", ""))


def test_what_the_rows_allow_is_no_problem() -> None:
    allowed = [
        one_import("roomba_ros.nodes", "roomba.brain.mission"),
        one_import("roomba_ros.nodes", "roomba.grid"),
        one_import("roomba.brain.mission", "roomba.brain.maps"),
        one_import("roomba.brain.maps", "roomba.errors"),
    ]
    assert problems(ROWS, FOLDERS, allowed) == []


@pytest.mark.parametrize(
    ("importer", "imported"),
    [
        ("roomba.brain.maps", "roomba.brain.mission"),
        ("roomba.brain.mission", "roomba_ros.nodes"),
        ("roomba.errors", "roomba.brain.maps"),
    ],
)
def test_an_import_that_no_row_allows_is_told(importer: str, imported: str) -> None:
    (problem,) = problems(ROWS, FOLDERS, [one_import(importer, imported)])
    assert problem == f"{importer}.a imports {imported}.b: {importer} may not import {imported}"


@pytest.mark.parametrize(
    ("rows", "folders", "problem"),
    [
        (ROWS, [*FOLDERS, "roomba.ui"], "roomba.ui: add a row for it"),
        (ROWS, FOLDERS[1:], "roomba_ros.nodes: there is no such folder"),
        ([ROWS[0], *ROWS], FOLDERS, "roomba_ros.nodes: it has two rows"),
        (
            [*ROWS[:2], Row(("roomba.brain.maps",), ("roomba.brain.mission",)), ROWS[3]],
            FOLDERS,
            "roomba.brain.maps: may import roomba.brain.mission, whose row is not below",
        ),
        (
            [*ROWS[:2], Row(("roomba.brain.maps",), ("roomba.brian",)), ROWS[3]],
            FOLDERS,
            "roomba.brain.maps: may import roomba.brian, which is no folder",
        ),
    ],
)
def test_rows_that_are_no_layers_are_told(
    rows: list[Row], folders: list[str], problem: str
) -> None:
    assert problems(rows, folders, []) == [problem]


def test_the_page_of_the_design_is_the_tree() -> None:
    graph = grimp.build_graph("roomba", "roomba_ros", cache_dir=None)
    assert problems(rows_of(DESIGN.read_text()), folders_in(graph), imports_in(graph)) == []
