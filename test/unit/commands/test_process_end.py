"""A command whose output is closed, or that gets Ctrl-C, ends without a traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
OTHERS = (
    "src/roomba_ros/bags/sim_bag.py",
    "src/roomba_bench/__main__.py",
    "lint/bill_of_materials.py",
)
COMMANDS = sorted(
    str(file.relative_to(ROOT))
    for file in [*(ROOT / "src/roomba/commands").rglob("*.py"), *(ROOT / name for name in OTHERS)]
    if "sys.exit(main())" in file.read_text("utf-8")
)
"""The files that ``./roomba`` runs."""
PRINTING = (
    "import sys\n"
    "from roomba.commands.process_end import quiet_end\n"
    "with quiet_end():\n"
    "    {}\n"
    "    sys.exit(0)\n"
)


def ended(*words: str, is_read: bool = False) -> tuple[int, str]:
    """Run Python; return its status and what it complained of, its output closed or thrown away."""
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, *words],
        stdout=subprocess.DEVNULL if is_read else writer,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
        text=True,
        timeout=60.0,
    )
    os.close(writer)
    return done.returncode, done.stderr


@pytest.mark.parametrize(
    "printed",
    ["print('one line')", "print('x' * 1_000_000)", "print('at once', flush=True)"],
)
def test_a_closed_output_ends_a_command_in_silence(printed: str) -> None:
    assert ended("-c", PRINTING.format(printed)) == (1, "")


def test_a_parser_that_ends_the_process_is_covered() -> None:
    asked = "import argparse; argparse.ArgumentParser().parse_args(['--help'])"
    assert ended("-c", PRINTING.format(asked)) == (1, "")


def test_a_full_disk_is_told_in_a_line() -> None:
    words = (sys.executable, "-c", PRINTING.format("print('one line')"))
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            words, stdout=full, stderr=subprocess.PIPE, env=environment, text=True, timeout=60.0
        )
    assert done.returncode == 1
    assert done.stderr.startswith("expected room for what is written: ")
    assert len(done.stderr.splitlines()) == 1


def test_a_lack_of_memory_is_told_in_a_line() -> None:
    status, said = ended("-c", PRINTING.format("b'x' * 2**62"), is_read=True)
    assert (status, said.count("\n")) == (1, 1)
    assert "expected more memory than there is" in said


def test_an_output_that_was_closed_before_is_none() -> None:
    closed = f'exec {sys.executable} -c "{PRINTING.format("print(1)")}" >&-'
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(
        ["bash", "-c", closed], stderr=subprocess.PIPE, env=environment, text=True, timeout=60.0
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_a_terminal_that_lacks_a_sign_shows_another_one() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PRINTING.format("print('57 m\\u00b2')")],
        capture_output=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONIOENCODING": "ascii"},
        text=True,
        timeout=60.0,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "57 m?\n", "")


def test_ctrl_c_is_told_in_a_line() -> None:
    raised = f"import signal; signal.raise_signal({int(signal.SIGINT)})"
    assert ended("-c", PRINTING.format(raised), is_read=True) == (130, "stopped on the way\n")


def test_ctrl_c_while_modules_are_loaded_ends_the_process_at_once() -> None:
    program = (
        "import signal\n"
        "from roomba.commands.process_end import quiet_loading\n"
        "with quiet_loading():\n"
        "    try:\n"
        "        signal.raise_signal(signal.SIGINT)\n"
        "    except BaseException as error:\n"
        "        raise ImportError('as compiled modules do') from error\n"
    )
    assert ended("-c", program, is_read=True) == (130, "stopped on the way\n")


def test_an_interrupt_that_a_shell_ignores_stays_ignored_while_modules_are_loaded() -> None:
    program = (
        "import signal\n"
        "from roomba.commands.process_end import quiet_loading\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "with quiet_loading():\n"
        "    signal.raise_signal(signal.SIGINT)\n"
        "assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN\n"
    )
    assert ended("-c", program, is_read=True) == (0, "")


def test_the_status_of_a_command_stays() -> None:
    assert ended("-c", PRINTING.format("sys.exit(3)"), is_read=True) == (3, "")


def test_what_is_wrong_is_still_told() -> None:
    status, complaint = ended("-c", PRINTING.format("1 / 0"), is_read=True)
    assert status == 1
    assert "ZeroDivisionError" in complaint


@pytest.mark.parametrize("words", ["exercise", "doctor", "program status"])
def test_help_ends_so(words: str) -> None:
    module, *command = words.split()
    assert ended("-m", f"roomba.commands.{module}", *command, "--help") == (1, "")


@pytest.mark.parametrize("file", COMMANDS)
def test_each_command_ends_so(file: str) -> None:
    assert "with quiet_end():" in (ROOT / file).read_text("utf-8")


def test_no_command_was_overlooked() -> None:
    assert len(COMMANDS) > 6
