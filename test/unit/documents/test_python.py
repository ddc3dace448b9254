"""Python in the documents runs as it stands; what needs the running robot is there to import."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
ROS = ("roomba_ros", "roomba_robot", "rospy", "actionlib")
"""Modules by which a program needs the graph; ``test/ros`` runs such a program."""


def blocks_of(page: Path) -> list[str]:
    """Return the blocks of a page that are Python: they import, or go on with what was made."""
    text = page.read_text(encoding="utf-8")
    blocks = re.findall(r"(?:^    .*\n(?:\n+(?=    ))?)+", text, re.MULTILINE)
    # A block may begin with how it is set up.
    whole = (re.sub(r"^    (\./roomba .*\n\n?)?", "", block, flags=re.M) for block in blocks)
    return [block for block in whole if re.match(r"import |from |[\w, ]+ = \w+[.(]", block)]


def imports_of(block: str) -> list[tuple[str, str]]:
    """Return the modules that a block imports, each with a name of it, or without one."""
    found = []
    for node in ast.walk(ast.parse(block)):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found += [(node.module or "", alias.name) for alias in node.names]
    return found


def needs_ros(block: str) -> bool:
    return any(module.split(".")[0] in ROS for module, _ in imports_of(block))


ALL = {page.name: blocks_of(page) for page in PAGES if blocks_of(page)}


def test_the_pages_with_python_are_known() -> None:
    assert {name: len(blocks) for name, blocks in ALL.items()} == {
        "README.md": 1,
        "gym.md": 2,
        "programs.md": 3,
        "real_robots.md": 2,
    }


@pytest.mark.parametrize("name", ALL)
def test_what_needs_no_ros_runs(name: str) -> None:
    made: dict[str, object] = {}
    for block in ALL[name]:
        if not needs_ros(block):
            exec(compile(block, name, "exec"), made)  # noqa: S102


@pytest.mark.parametrize(
    ("module", "name"),
    sorted({each for blocks in ALL.values() for block in blocks for each in imports_of(block)}),
)
def test_what_is_imported_is_there(module: str, name: str) -> None:
    if module.split(".")[0] in ROS:
        pytest.importorskip("roomba_robot.msg", reason="needs ROS, as the program does")
    assert not name or hasattr(importlib.import_module(module), name)
