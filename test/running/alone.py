"""Runs tests that failed beside other tests once more, with nothing beside them.

Promises in wall time do not always hold on a machine that is busy with other tests. A test that
fails twice has failed. Those that pass alone are named at the end: a busy machine breaks them.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.pytests import pytest_command
from running.suites import ROOT

FEW: Final = 4
"""If more tests than this fail, a busy machine is not the reason."""
FAILED: Final = 1
"""The exit status of pytest when tests failed, and nothing else was wrong."""


def listing(path: Path) -> tuple[str, ...]:
    """Return the arguments by which pytest writes the names of tests that failed to a file."""
    return ("-p", "running.failed", "--failed-to", str(path))


def listed(path: Path) -> list[str]:
    """Return the names in that file; none if pytest ended before it wrote the file."""
    return path.read_text(encoding="utf-8").splitlines() if path.exists() else []


def pass_alone(names: Sequence[str]) -> bool:
    """Whether the tests that failed beside others are few, and all pass alone."""
    if not 0 < len(names) <= FEW:
        return False
    print(f"{len(names)} failed beside others: once more, alone", flush=True)
    passed = [subprocess.run(pytest_command(name), cwd=ROOT).returncode == 0 for name in names]
    for name, alone in zip(names, passed, strict=True):
        print(f"{'PASSED ONLY ALONE' if alone else 'FAILED TWICE'}: {name}", flush=True)
    return all(passed)
