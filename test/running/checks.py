"""``./roomba test lint``: programs that read the sources and say what is wrong with them."""

from __future__ import annotations

import subprocess
from typing import Final

from running.suites import ROOT

CHECKS: Final = {
    "ruff check": ("ruff", "check", "."),
    "ruff format": ("ruff", "format", "--check", "."),
    "mypy": ("mypy",),
    "import contracts": ("lint-imports", "--cache-dir", ".cache/import-linter"),
    "shellcheck": ("shellcheck", "-x", "roomba", "set_up.sh", "install_dependencies.sh", ".ci/run"),
    "catkin_lint": ("catkin_lint", "-W2", "--strict", ".workspace/src/roomba_robot"),
}


def run_checks() -> int:
    """Run all checks; print a line for each, and what it found; return 0 if none found anything."""
    passed = [_passes(name, command) for name, command in CHECKS.items()]
    return 0 if all(passed) else 1


def _passes(name: str, command: tuple[str, ...]) -> bool:
    ran = subprocess.run(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if ran.returncode:
        print(f"lint: {name:<18} FAILED: {' '.join(command)}\n{ran.stdout}", flush=True)
    else:
        print(f"lint: {name:<18} ok", flush=True)
    return ran.returncode == 0


if __name__ == "__main__":
    raise SystemExit(run_checks())
