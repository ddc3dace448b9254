"""Launch files evaluate no code: an argument of the command line would be a program."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("path", sorted((ROOT / "launch").rglob("*.launch")), ids=lambda p: p.name)
def test_it_evaluates_nothing(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert "<launch>" in text
    assert "$(eval" not in text
    assert "<rosparam" not in text
