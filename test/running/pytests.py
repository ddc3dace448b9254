"""How pytest is called."""

from __future__ import annotations

import sys
from typing import Final

from running.suites import ROOT

NO_TESTS: Final = 5
"""The exit status of pytest when no test matches what was asked for."""


def pytest_command(*arguments: str) -> list[str]:
    """Return the command that runs tests with the settings of the project."""
    settings = ["--rootdir", str(ROOT), "-c", str(ROOT / "pyproject.toml")]
    return [sys.executable, "-m", "pytest", *settings, *arguments]
