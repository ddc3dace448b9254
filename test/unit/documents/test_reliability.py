"""Each test that the page of promises names is there, and no promise is without one."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).parents[3]
PAGE: Final = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
NAMED: Final = sorted(set(re.findall(r"`(test/[^`\s]+)`", PAGE)))
ROWS: Final = [
    line
    for line in PAGE.splitlines()
    if line.startswith("| ") and not line.startswith(("| what", "| from"))
]


def test_the_page_names_tests() -> None:
    assert len(NAMED) > 40
    assert len(ROWS) > 60


@pytest.mark.parametrize("name", NAMED)
def test_a_test_that_is_named_is_there(name: str) -> None:
    file, _, function = name.partition("::")
    path = ROOT / file
    assert path.exists()
    if function:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        names = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        assert function in names
    if path.is_dir():
        assert list(path.rglob("test_*.py"))


@pytest.mark.parametrize("row", ROWS)
def test_a_promise_has_a_test(row: str) -> None:
    assert re.search(r"`(test/|\./roomba )", row)


def tables() -> list[list[list[str]]]:
    """Return the cells of each row of each table of the page, the head and the line below too."""
    found: list[list[list[str]]] = []
    before = ""
    for line in PAGE.splitlines():
        if line.startswith("|"):
            if not before.startswith("|"):
                found.append([])
            found[-1].append([cell.strip() for cell in line.strip("|").split("|")])
        before = line
    return found


def test_each_table_has_one_head_and_rows_as_wide() -> None:
    for head, rule, *rows in tables():
        assert set("".join(rule)) == {"-"}, head
        assert rows, head
        assert {len(row) for row in (rule, *rows)} == {len(head)}, head
        assert head[0].startswith("what "), head
        assert not any(row[0].startswith("what goes wrong") for row in rows), head


def test_each_part_says_something_before_the_next_begins() -> None:
    parts = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
    assert len(parts) >= 10
    assert [part for part in parts if len(part.splitlines()) < 4] == []


def test_all_cases_of_both_lists_have_a_row() -> None:
    """25 that broke the running graph, and 32 that broke the robot of the report."""
    sizes = [len(rows) for head, _, *rows in tables() if len(head) == 5]
    assert sizes == [25, 32]
