"""``./roomba emulate neato`` as a program of another person finds it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fixtures.waiting import wait_until

from roomba.commands.emulate.command import main
from roomba.drivers.line import SerialLine
from roomba.drivers.neato.conversation import Conversation


def test_it_answers_on_its_line_until_it_is_interrupted(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    words = [sys.executable, "-m", "roomba.commands.emulate", "neato", "--link", str(link)]
    emulator = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    try:
        wait_until(link.is_symlink, 30.0, "the line is there")
        line = Conversation(SerialLine(os.fspath(link), 115_200), time.monotonic)
        assert line.ask("GetVersion", 10.0)[0].startswith("Component")
        line.close()
        emulator.send_signal(signal.SIGINT)
        told, _ = emulator.communicate(timeout=10.0)
    finally:
        emulator.kill()
    assert emulator.returncode == 0
    assert str(link) in told
    assert not os.path.lexists(link)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("neato --home nowhere", "nowhere"),
        ("neato --speed 0", "a number from 0.1 to 20"),
        ("neato --model d9", "expected botvac, xv11"),
        ("other", "invalid choice"),
    ],
)
def test_what_there_is_not_is_told(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words.split()) == 2
    assert said in capsys.readouterr().err


def test_a_file_is_not_replaced_by_the_link(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = tmp_path / "notes"
    kept.write_text("mine", encoding="utf-8")
    assert main(["neato", "--link", str(kept)]) == 2
    assert "a file is there" in capsys.readouterr().err
    assert kept.read_text(encoding="utf-8") == "mine"
