"""``./roomba test safety`` and ``mutants``: whether tests run and check all of the safety layer."""

from __future__ import annotations

import subprocess
import sys

from safety.layer import ROOT, layer
from safety.mutants import find_mutants


def cover() -> int:
    """Run the tests; return 0 if they passed, and ran each line and branch of the layer."""
    modules, tests = layer()
    coverage = [sys.executable, "-m", "coverage"]
    data = f"--data-file={ROOT / '.cache' / 'coverage'}"
    pytest = ["-m", "pytest", "-c", "pyproject.toml", "--rootdir", ".", *tests]
    include = f"--include={','.join(modules)}"
    ran = subprocess.run([*coverage, "run", "--branch", data, include, *pytest], cwd=ROOT)
    if ran.returncode:
        return ran.returncode
    report = [*coverage, "report", data, include, "--fail-under=100", "--show-missing"]
    return subprocess.run(report, cwd=ROOT).returncode


if __name__ == "__main__":
    raise SystemExit(find_mutants() if sys.argv[1:] == ["mutants"] else cover())
