"""The parts without ROS, on a Linux without the calls that other systems lack.

Nothing here shows that it works there: only that it asks for no module and no call of Linux.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

NO_LINUX = """
import os
del os.sched_getaffinity
"""
"""For macOS, which has what POSIX has."""
NO_POSIX = """
import os, signal, sys
for name in ("fcntl", "grp", "pty", "pwd", "resource", "termios", "tty"):
    sys.modules[name] = None
for name in (
    "O_CLOEXEC", "O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK", "fork", "geteuid", "getuid", "killpg",
    "sched_getaffinity",
):
    delattr(os, name)
for name in ("SIGHUP", "SIGKILL", "SIGUSR1", "pthread_sigmask"):
    delattr(signal, name)
"""
"""For Windows."""
CLEAN = "from roomba.commands.sim.command import main; raise SystemExit(main())"
AGENT = """
import gymnasium, roomba.gym
environment = gymnasium.make("RoombaClean-v0", home="studio")
environment.reset(seed=1)
assert environment.step(environment.action_space.sample())[0] is not None
"""


def python(folder: Path, taken: str, program: str, *words: str) -> str:
    """Return the output of a program in a Python, and its children, without what is taken away."""
    (folder / "sitecustomize.py").write_text(taken)
    path = os.pathsep.join((str(folder), os.environ["PYTHONPATH"]))
    done = subprocess.run(
        [sys.executable, "-c", program, *words],
        env={**os.environ, "PYTHONPATH": path, "ROOMBA_HISTORY": str(folder / "history")},
        capture_output=True,
        text=True,
        check=False,
        timeout=120.0,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("taken", [NO_LINUX, NO_POSIX])
def test_it_cleans(tmp_path: Path, taken: str) -> None:
    told = json.loads(python(tmp_path, taken, CLEAN, "--home", "studio", "--json", "-"))
    assert (told["outcome"], told["docked"]) == ("COMPLETED", True)


def test_many_homes_are_cleaned_on_all_cores_without_calls_of_linux(tmp_path: Path) -> None:
    told = json.loads(python(tmp_path, NO_LINUX, CLEAN, "--homes", "2", "--json", "-"))
    assert len(told["runs"]) == 2


@pytest.mark.parametrize("taken", [NO_LINUX, NO_POSIX])
def test_the_environment_for_agents_works(tmp_path: Path, taken: str) -> None:
    python(tmp_path, taken, AGENT)
