"""The glossary names what exists, and a class name means one thing."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "src"
GLOSSARY = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in GLOSSARY.splitlines()
    if line.startswith("| ") and not line.startswith("| term")
]


def module_of(name: str) -> tuple[Path | None, str]:
    """Return the file that a dotted name leads to, and what of the name is left."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        path = SOURCES.joinpath(*parts[:count])
        for file in (path.with_suffix(".py"), path / "__init__.py"):
            if file.is_file():
                return file, ".".join(parts[count:])
    return None, name


def defined_in(file: Path) -> set[str]:
    return {
        node.name
        for node in ast.parse(file.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef | ast.FunctionDef)
    }


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_each_term_has_a_meaning_and_lives_where_the_page_says(row: list[str]) -> None:
    assert len(row) == 3
    assert row[1]
    names = re.findall(r"`([^`]+)`", row[2])
    assert names
    for name in names:
        file, rest = module_of(name)
        assert file is not None, f"there is no module {name}"
        assert not rest or rest in defined_in(file), f"{file} defines no {rest}"


def test_each_term_stands_once() -> None:
    assert len(ROWS) > 40
    terms = [row[0] for row in ROWS]
    assert len(set(terms)) == len(terms)


def test_no_two_classes_have_one_name() -> None:
    places = defaultdict(list)
    packages = [SOURCES / "roomba", SOURCES / "roomba_ros"]
    modules = [path for package in packages for path in package.rglob("*.py")]
    for file in sorted(modules):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                places[node.name].append(str(file.relative_to(SOURCES)))
    doubled = {name: files for name, files in places.items() if len(files) > 1}
    assert doubled == {}
