"""Tutorials at a glance: all of their blocks can be typed; two suites type them."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from fixtures.tutorial import Block, blocks_of

ROOT = Path(__file__).parents[3]
TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
SUITES = [ROOT / "test" / name / "test_tutorials.py" for name in ("teaching", "missions")]


def of(page: Path) -> list[Block]:
    return blocks_of(page.read_text("utf-8"))


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_every_block_is_a_file_or_typed_or_shown(page: Path) -> None:
    blocks = of(page)
    assert blocks or page.stem == "README"
    assert page.read_text("utf-8").count("\n```") == 2 * len(blocks)


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_python_of_a_tutorial_is_python(page: Path) -> None:
    for block in of(page):
        if block.language == "python":
            compile(block.text, block.title, "exec")


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_file_that_is_run_is_one_of_the_page_or_of_the_checkout(page: Path) -> None:
    there = {block.title for block in of(page)}
    for block in of(page):
        for name in re.findall(r"python3? ([\w/]+\.py)", block.text if not block.title else ""):
            assert name in there or (ROOT / name).is_file(), f"line {block.line}: {name}"


def test_each_is_typed_by_a_suite() -> None:
    suites = "".join(path.read_text("utf-8") for path in SUITES)
    typed = {page.stem for page in TUTORIALS if f'"{page.stem}"' in suites}
    assert typed == {page.stem for page in TUTORIALS} - {"README"}


def test_one_leads_to_the_next_in_the_order_of_the_list_and_of_the_site() -> None:
    folder = ROOT / "docs" / "tutorials"
    table, site = (
        (folder / "README.md").read_text("utf-8"),
        (ROOT / "mkdocs.yml").read_text("utf-8"),
    )
    listed = re.findall(r"^\| \[[^]]+\]\((\w+)\.md\)", table, re.M)
    assert re.findall(r"tutorials/([a-z]\w+)\.md", site) == listed
    for one, other in itertools.pairwise(listed):
        _, _, led = (folder / f"{one}.md").read_text("utf-8").rpartition("Next:")
        assert re.findall(r"\((\w+)\.md\)", led)[:1] == [other], one
