"""Settings of the calling shell do not disturb a program of ROS."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


def bash(script: str) -> str:
    """Return what a script prints that begins with all functions of the set-up."""
    done = subprocess.run(
        ["bash", "-c", f"source {ROOT}/set_up.sh; {script}"],
        env={**os.environ, "PYTHONPATH": "/of/the/shell"},
        capture_output=True,
        text=True,
        check=True,
        timeout=30.0,
    )
    return done.stdout.strip()


def test_no_module_of_the_calling_shell_comes_before_those_of_ros(tmp_path: Path) -> None:
    setup = tmp_path / "devel" / "setup.bash"
    setup.parent.mkdir()
    setup.write_text("export PYTHONPATH=/of/ros${PYTHONPATH:+:$PYTHONPATH}\n", encoding="utf-8")
    told = bash(f"WORKSPACE={tmp_path}; enter_environment; printenv PYTHONPATH")
    assert told.split(":") == [f"{ROOT}/src", "/of/ros"]


@pytest.mark.parametrize("words", ["", "--requirement a.txt"])
def test_an_installation_sees_none_of_them(tmp_path: Path, words: str) -> None:
    python = tmp_path / "bin" / "python3"
    python.parent.mkdir()
    python.write_text('#!/bin/sh\necho "${PYTHONPATH:-none}" "$@"\n', encoding="utf-8")
    python.chmod(0o755)
    told = bash(f"pip_install {tmp_path} {words}")
    assert told.startswith("none -m pip install --no-input ")
    assert told.endswith(words)
