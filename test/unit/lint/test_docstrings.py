"""A docstring is read alone, beside the name that it describes: it begins and ends by itself."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
FOLDERS = ("src", "lint")
HALF = re.compile(r"([Aa]nd|[Bb]ut|or|nor|which)\b|.*[,;]$", re.DOTALL)
"""How one goes on from the docstring before it, or into the one behind it."""


def docstrings(source: str) -> Iterator[tuple[int, str]]:
    """Yield the line and the text of each string that stands alone, as docstrings do."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Expr(value=ast.Constant(value=str(text))):
                yield node.lineno, text.strip()


def halves(source: str) -> list[tuple[int, str]]:
    """Return those that need another one to be understood."""
    return [(line, text) for line, text in docstrings(source) if HALF.match(text)]


def test_no_docstring_goes_on_in_another_one() -> None:
    files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py"))]
    found = {str(path.relative_to(ROOT)): halves(path.read_text("utf-8")) for path in files}
    assert {path: texts for path, texts in found.items() if texts} == {}


@pytest.mark.parametrize(
    ("text", "is_half"),
    [
        ("s; a robot that turns faster waits,", True),
        ("s; more is too long;", True),
        ("but no longer than that, s.", True),
        ("and so much more.", True),
        ("s; the robot waits, and then it turns.", False),
        ("Android phones.", False),
    ],
)
def test_a_half_is_known_by_its_ends(text: str, is_half: bool) -> None:
    assert bool(halves(f'WAIT = 1.0\n"""{text}"""\n')) == is_half
