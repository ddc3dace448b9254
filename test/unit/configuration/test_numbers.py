"""Numbers of the robot, its home and its behaviour stand in the configuration, not in modules.

A module keeps the numbers of its algorithm: tolerances, steps and budgets of a search, codes. In
the parts that decide what the robot does each of them is told here, with the reason.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[3] / "src" / "roomba"

ROUNDING = "rounding: less than this is nothing"
SEARCH = "a step, a window or a budget of a search: a finer or larger one finds the same, later"
MEMORY = "the size of a buffer"
CODE = "a code, or a column of an array"
WORDS = "decides which words are told, not what is done"
CORRECTION = "makes up for how another part thickens or rounds what it gives"

STAYS: dict[str, dict[str, str]] = {
    "control": {"SHORTEST_LEG": ROUNDING, "_STRAIGHT": ROUNDING},
    "mission": {
        "VERSION": CODE,
        "_ALL": CODE,
        "_NEVER": CODE,
        "MOST_PASSES": "a limit of a request: more over the same floor are a slip of the finger",
        "_MOSTLY": WORDS,
        "_HARDLY_ANY": WORDS,
        "_SIZE": CORRECTION,
        "_ALONE": CORRECTION,
        "_SPARED": CORRECTION,
        "_LEAST": CORRECTION,
        "LEAVING": CORRECTION,
        "_NEARLY": ROUNDING,
        "_TOUCHES": MEMORY,
        "_LENGTH": MEMORY,
        "_REMEMBERED": MEMORY,
        **dict.fromkeys(
            (
                *("_AHEAD", "_DIRECTIONS", "_EVERY", "_FREE_RUN", "_HORIZON", "_MOST_TRIES"),
                *("_ROUNDS", "_SEARCH_AHEAD", "_STEP", "_STRETCH"),
            ),
            SEARCH,
        ),
    },
    "robot": {
        "_BESIDE_SURFACES": CORRECTION,
        "_AROUND_GOAL": SEARCH,
    },
}
"""Of each part, the names of its numbers that may stay, and why."""


def numbers_of(source: str) -> Iterator[str]:
    """Yield the names of a module's constants that are numbers, or made of numbers alone."""
    for node in ast.parse(source).body:
        targets: list[ast.expr]
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            targets, value = [node.target], node.value
        elif isinstance(node, ast.Assign):
            targets, value = node.targets, node.value
        else:
            continue
        if _is_numeric(value):
            for target in targets:
                names = target.elts if isinstance(target, ast.Tuple) else [target]
                yield from (name.id for name in names if isinstance(name, ast.Name))


def _is_numeric(value: ast.expr) -> bool:
    match value:
        case ast.Constant(value=number):
            return isinstance(number, int | float) and not isinstance(number, bool)
        case ast.UnaryOp(operand=operand):
            return _is_numeric(operand)
        case ast.BinOp(left=left, right=right):
            return _is_numeric(left) and _is_numeric(right)
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return bool(parts) and all(map(_is_numeric, parts))
        case ast.Call(func=ast.Attribute(), args=parts):
            return bool(parts) and all(map(_is_numeric, parts))
        case ast.Dict(values=parts):
            return bool(parts) and all(map(_is_numeric, parts))
    return False


def numbers_in(part: str) -> dict[str, str]:
    """Return the constants of a part of the brain that are numbers, each with a file of it."""
    return {
        name: str(path.relative_to(SOURCE))
        for path in sorted((SOURCE / part).rglob("*.py"))
        for name in numbers_of(path.read_text(encoding="utf-8"))
    }


@pytest.mark.parametrize("part", STAYS)
def test_numbers_stand_in_the_configuration(part: str) -> None:
    found = numbers_in(part)
    astray = {name: file for name, file in found.items() if name not in STAYS[part]}
    assert astray == {}, "move them to roomba/configuration, or tell here why they stay"
    assert [name for name in STAYS[part] if name not in found] == [], "they are gone: forget them"


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("SPEED: Final = 0.3\n", ["SPEED"]),
        ("_NEAR = -math.radians(4.0)\n", ["_NEAR"]),
        ("A, B = 1, 2.0\n", ["A", "B"]),
        ("MOVES = ((1.0, 2), (3, 4.5))\n", ["MOVES"]),
        ("SPREAD = np.diag([0.1**2, 0.1**2])\n", ["SPREAD"]),
        ("BY_KIND = {'chair': 0.4}\n", ["BY_KIND"]),
        ("NAME = 'one'\nIS_ON = True\nROW = np.dtype([('x', 'f8')])\n", []),
        ("def f():\n    speed = 0.3\n", []),
    ],
)
def test_a_number_is_found_however_it_is_written(source: str, names: list[str]) -> None:
    assert list(numbers_of(source)) == names
