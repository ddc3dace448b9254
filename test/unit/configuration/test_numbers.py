"""Numbers of the robot, its home and its behaviour stand in the configuration, not in modules.

A module keeps the numbers of its algorithm: tolerances, steps and budgets of a search, codes. Each
of them stands in ``numbers_that_stay.yaml``, by folder and by the reason for which it stays.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

SOURCE = Path(__file__).resolve().parents[3] / "src"
_TOLD = yaml.safe_load(Path(__file__).with_name("numbers_that_stay.yaml").read_text("utf-8"))
REASONS: dict[str, str] = _TOLD["reasons"]
STAYS: dict[str, dict[str, str]] = _TOLD["numbers"]
"""Of each folder the names of its numbers that may stay, by the reason, one of ``REASONS``."""


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


def numbers_in(folder: str) -> dict[str, str]:
    """Return the constants of a folder's modules that are numbers, each with a file of it."""
    return {
        name: path.name
        for path in sorted((SOURCE / folder).glob("*.py"))
        for name in numbers_of(path.read_text(encoding="utf-8"))
    }


def folders() -> list[str]:
    """Return all folders of the robot's sources that have modules.

    The numbers of ``roomba_bench`` are aims, and how much of something is measured.
    """
    packages = [SOURCE / "roomba", SOURCE / "roomba_ros"]
    modules = [path for package in packages for path in package.rglob("*.py")]
    return sorted({str(path.parent.relative_to(SOURCE)) for path in modules})


@pytest.mark.parametrize("folder", folders())
def test_numbers_stand_in_the_configuration(folder: str) -> None:
    found = numbers_in(folder)
    stays = {name for names in STAYS.get(folder, {}).values() for name in names.split()}
    astray = {name: file for name, file in found.items() if name not in stays}
    assert astray == {}, "move them to roomba/configuration, or tell in the file why they stay"
    assert stays - set(found) == set(), "they are gone: forget them"


def test_nothing_is_told_of_folders_without_numbers() -> None:
    assert set(STAYS) == {folder for folder in folders() if numbers_in(folder)}


def test_every_reason_is_one_and_is_needed() -> None:
    assert {reason for told in STAYS.values() for reason in told} == set(REASONS)


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
