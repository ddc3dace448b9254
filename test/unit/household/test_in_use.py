"""Two programs with one household: the second is told so, unless the first has ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from roomba.household.in_use import InUse

OTHER = """
import sys, time
from pathlib import Path
from roomba.household.in_use import InUse
InUse(Path(sys.argv[1]), print).begin()
print("begun", flush=True)
time.sleep(600)
"""


def test_the_process_that_keeps_it_already_is_told_until_it_is_killed(tmp_path: Path) -> None:
    folder, told = tmp_path / "household", list[str]()
    other = subprocess.Popen(
        [sys.executable, "-c", OTHER, str(folder)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert other.stdout is not None
        assert other.stdout.readline() == "begun\n"
        InUse(folder, told.append).begin()
        (text,) = told
        assert text.startswith(f"process {other.pid} keeps this household as well ({folder})")
    finally:
        other.send_signal(signal.SIGKILL)
        other.communicate()
    mine = InUse(folder, pytest.fail)
    mine.begin()
    assert (folder / "in_use").read_text("ascii") == f"{os.getpid()}\n"
    mine.end()
    again = InUse(folder, pytest.fail)
    again.begin()
    again.end()


def test_one_that_came_second_has_it_when_the_first_one_ended(tmp_path: Path) -> None:
    first, told = InUse(tmp_path, pytest.fail), list[str]()
    first.begin()
    second, third = InUse(tmp_path, told.append), InUse(tmp_path, told.append)
    second.begin()
    second.look()
    first.end()
    second.look()
    third.begin()
    assert len(told) == 2
    second.end()
    third.end()


def test_a_folder_that_cannot_be_made_is_no_trouble(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", "ascii")
    mark = InUse(tmp_path / "file" / "household", pytest.fail)
    mark.begin()
    mark.end()
