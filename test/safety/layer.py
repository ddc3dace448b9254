"""Which modules are the safety layer, and which tests must cover all of it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import yaml

ROOT: Final = Path(__file__).resolve().parents[2]


def layer() -> tuple[list[str], list[str]]:
    """Return the files of the modules, and those of the tests, relative to the repository."""
    found = yaml.safe_load(Path(__file__).with_name("layer.yaml").read_text(encoding="utf-8"))
    return found["modules"], found["tests"]
