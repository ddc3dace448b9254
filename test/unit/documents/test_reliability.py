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
