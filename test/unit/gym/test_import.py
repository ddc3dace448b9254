import os
import subprocess
import sys


def import_without_gymnasium(module: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", f"import sys; sys.modules['gymnasium'] = None; import {module}"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )


def test_without_gymnasium_it_says_how_to_install_it() -> None:
    tried = import_without_gymnasium("roomba.gym")
    assert tried.returncode != 0
    last = tried.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: roomba.gym: expected the package gymnasium")
    assert "pip install 'gymnasium>=1.1'" in last


def test_nothing_else_needs_it() -> None:
    assert import_without_gymnasium("roomba.world.simulator").returncode == 0
