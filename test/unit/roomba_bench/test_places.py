"""Where things lie, in a checkout and without one."""

from __future__ import annotations

import sys
from pathlib import Path

from roomba_bench.places import Places


def test_a_checkout_has_its_own_command_results_and_python_of_the_peers(tmp_path: Path) -> None:
    (tmp_path / "roomba").touch()
    python = tmp_path / ".venv-bench" / "bin" / "python3"
    assert Places.of(tmp_path).peers is None
    python.parent.mkdir(parents=True)
    python.touch()
    results = tmp_path / "benchmarks" / "results"
    assert Places.of(tmp_path) == Places(tmp_path, tmp_path / "roomba", results, python)


def test_elsewhere_the_program_stands_beside_its_python(tmp_path: Path) -> None:
    (tmp_path / "roomba").mkdir()  # the package, in the folder of all packages
    program = Path(sys.executable).parent / "roomba"
    assert Places.of(tmp_path) == Places(tmp_path, program, Path("bench.results"), None)
