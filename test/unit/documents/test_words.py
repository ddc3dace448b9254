"""Texts name their subject: the caller, the operator, the node, the robot."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[3]
VAGUE = re.compile(
    r"(?<![a-z])(whoever|whomever|somebody|nobody|everybody|anybody)(?![a-z])", re.IGNORECASE
)
PLACES = ("src", "docs", "msg", "srv", "action", "launch", "examples", "scripts", "lint", "test")
ENDINGS = {".action", ".launch", ".md", ".msg", ".py", ".srv", ".yaml"}


def test_no_text_leaves_open_which_person_or_program_is_meant() -> None:
    files = [
        *ROOT.glob("*.md"),
        *(path for place in PLACES for path in (ROOT / place).rglob("*") if path.suffix in ENDINGS),
    ]
    files.remove(Path(__file__))
    assert len(files) > 400
    found = [
        (str(path.relative_to(ROOT)), number, line.strip())
        for path in files
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if VAGUE.search(line)
    ]
    assert found == []
