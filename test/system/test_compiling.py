"""What the set-up compiles before the robot runs, what beside it, and that it compiles once."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.waiting import promised

from roomba.compiled_sources import PACKAGE

REPOSITORY = Path(__file__).resolve().parents[2]
MAPPING = "-m roomba.commands.map.warm"
DEADLINE = 30.0
"""s that a script, or what it began in the background, may take."""
PYTHON = f"""#!/bin/sh
[ "$2" != roomba.compiled_sources ] || exec {sys.executable} "$@"
echo "$*" >>calls
case "$*" in
  *compiling) echo 7 ;;
  *map.warm) while [ -e held ]; do sleep 0.01; done; [ ! -e broken_map ] ;;
  *first_use*) [ ! -e broken ] ;;
esac
"""
"""Stands for Python: notes what it is to run, and maps not before it may. It knows the sources."""


class Checkout:
    """The scripts of the set-up, a loop that imports, and a Python that compiles nothing."""

    def __init__(self, folder: Path) -> None:
        """Make them as if all other steps were done, without ROS."""
        self.folder = folder
        for name in ("set_up.sh", "install_dependencies.sh"):
            shutil.copy2(REPOSITORY / name, folder)
        (folder / "src/roomba").mkdir(parents=True)
        (folder / ".venv/bin").mkdir(parents=True)
        (folder / ".venv/.stamp-library").write_text("made\n")
        for name in ("__init__.py", "compiled_sources.py"):
            shutil.copy2(PACKAGE / name, folder / "src/roomba")
        self.number = folder / "src/roomba/number.py"
        self.number.write_text("NUMBER = 1\n")
        self.loop = folder / "src/roomba/loop.py"
        self.loop.write_text(
            "from roomba.compilation import entry\nfrom roomba.number import NUMBER\n"
        )
        program = folder / ".venv/bin/python3"
        program.write_text(PYTHON)
        program.chmod(0o755)

    def does(self, script: str) -> tuple[bool, str]:
        """Run commands of the set-up; return whether the last one did well, and what was told."""
        steps = "library_is_current() { true; }; install_dependencies() { true; }"
        done = subprocess.run(
            ["bash", "-c", f"set -euo pipefail; . ./set_up.sh; {steps}; {script}"],
            cwd=self.folder,
            env={"PATH": os.environ["PATH"], "HOME": str(self.folder)},
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )
        return done.returncode == 0, done.stderr

    @property
    def calls(self) -> list[str]:
        """What Python was called for since this was asked to forget."""
        file = self.folder / "calls"
        return file.read_text(encoding="utf-8").splitlines() if file.exists() else []

    def forget(self) -> None:
        """Begin to note calls anew."""
        (self.folder / "calls").unlink(missing_ok=True)

    def wait(self, condition: Callable[[], bool]) -> None:
        """Wait until something is so."""
        promised(condition, DEADLINE, lambda: str(self.calls))

    def is_complete(self) -> bool:
        """Whether all is compiled."""
        return self.does("compiled_is_complete")[0]


@pytest.fixture
def checkout(tmp_path: Path) -> Checkout:
    return Checkout(tmp_path)


def test_a_command_goes_on_while_the_rest_is_compiled_and_says_so(checkout: Checkout) -> None:
    held = checkout.folder / "held"
    held.touch()
    done, told = checkout.does("set_up library")
    assert done
    assert "It is usable; 7 loops are still being compiled in the background" in told
    assert checkout.does("compiled_is_current")[0]
    assert not checkout.is_complete()
    assert "7 loops are still being compiled" in checkout.does("set_up library")[1]
    held.unlink()
    checkout.wait(checkout.is_complete)
    # One process compiled the rest, though two commands wanted it.
    assert checkout.calls.count(MAPPING) == 1
    checkout.forget()
    assert checkout.does("set_up library") == (True, "")
    assert checkout.calls == []


def test_with_the_packages_of_ros_and_no_workspace_yet_it_compiles_all_the_same(
    checkout: Checkout,
) -> None:
    (checkout.folder / ".venv/.stamp-library").rename(checkout.folder / ".venv/.stamp-runtime")
    done, told = checkout.does("set_up library")
    assert done, told
    checkout.wait(checkout.is_complete)


def test_to_go_back_to_a_branch_compiles_nothing(checkout: Checkout) -> None:
    assert checkout.does("set_up library")[0]
    checkout.wait(checkout.is_complete)
    before = checkout.loop.read_text()
    checkout.loop.write_text(f"{before}# of another branch\n")
    assert not checkout.does("compiled_is_current")[0]
    assert checkout.does("set_up library")[0]
    checkout.wait(checkout.is_complete)
    assert checkout.calls.count(MAPPING) == 2
    checkout.forget()
    checkout.loop.write_text(before)
    assert checkout.does("set_up library") == (True, "")
    assert checkout.calls == []


def test_what_a_loop_imports_is_of_it_and_other_files_are_not(checkout: Checkout) -> None:
    assert checkout.does("set_up library")[0]
    checkout.wait(checkout.is_complete)
    (checkout.folder / "src/roomba/words.py").write_text("from roomba.number import NUMBER\n")
    assert checkout.is_complete()
    checkout.number.write_text("NUMBER = 2\n")
    assert not checkout.does("compiled_is_current")[0]


def test_of_sources_that_changed_meanwhile_nothing_is_said(checkout: Checkout) -> None:
    held = checkout.folder / "held"
    held.touch()
    assert checkout.does("set_up library")[0]
    checkout.wait(lambda: MAPPING in checkout.calls)
    checkout.loop.write_text("from roomba.compilation import part\n")
    held.unlink()
    assert checkout.does("flock .cache/compiling.lock true")[0]
    assert not checkout.does("compiled_is_current")[0]


def test_what_does_not_compile_holds_up_no_command(checkout: Checkout) -> None:
    (checkout.folder / "broken").touch()
    done, told = checkout.does("set_up library && echo goes on >&2")
    assert done, told
    assert "warning: not all could be compiled" in told
    assert told.endswith("goes on\n")
    assert not checkout.does("compiled_is_current")[0]


def test_what_failed_in_the_background_is_tried_again_by_the_next_command(
    checkout: Checkout,
) -> None:
    broken = checkout.folder / "broken_map"
    broken.touch()
    assert checkout.does("set_up library")[0]
    checkout.wait(lambda: MAPPING in checkout.calls)
    assert not checkout.is_complete()
    broken.unlink()
    assert checkout.does("set_up library")[0]
    checkout.wait(checkout.is_complete)


def test_tests_wait_for_all(checkout: Checkout) -> None:
    done = ["npm_is_current", "system_is_current", "python_is_current", "workspace_is_current"]
    steps = "; ".join(f"{step}() {{ true; }}" for step in done)
    assert not checkout.does(f"{steps}; set_up_is_complete dev")[0]
    has_ended, told = checkout.does(f"{steps}; set_up_missing_steps dev; set_up_is_complete dev")
    assert has_ended, told
    assert "Compiling all other loops" in told


def test_what_pip_left_without_bytecode_gets_it_beside(checkout: Checkout) -> None:
    assert checkout.does("set_up library")[0]
    checkout.wait(checkout.is_complete)
    made = [call for call in checkout.calls if call.startswith("-m compileall")]
    assert len(made) == 1


def test_the_set_up_of_these_tests_left_no_loop_to_be_compiled() -> None:
    """It counts them at its end. What it left would be compiled where a robot first needs it."""
    script = '. ./set_up.sh; compiled_is_complete && cat "$(compiled_stamp)"'
    told = subprocess.run(
        ["bash", "-c", script], cwd=REPOSITORY, capture_output=True, text=True, check=False
    )
    assert told.returncode == 0, f"the set-up is not complete; ./roomba test does it {told.stderr}"
    assert told.stdout.strip() == "0"
