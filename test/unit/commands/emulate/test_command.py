"""``./roomba emulate`` as a program of another person finds it."""

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
from roomba.configuration.sensors import LidarConfig
from roomba.drivers.lidars.ld19 import HEAD, Ld19Frames
from roomba.drivers.line import SerialLine
from roomba.drivers.neato.conversation import Conversation

EMULATE = (sys.executable, "-m", "roomba.commands.program", "emulate")


def test_it_answers_on_its_line_until_it_is_interrupted(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    words = [*EMULATE, "neato", "--link", str(link)]
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


def test_a_create2_and_its_lidar_are_on_lines_of_their_own(tmp_path: Path) -> None:
    link, lidar_link = tmp_path / "create2", tmp_path / "ld19"
    words = [*EMULATE, "create2", "--serial"]
    words += ["--baud", "19200", "--link", str(link), "--lidar-link", str(lidar_link)]
    emulator = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    try:
        wait_until(lidar_link.is_symlink, 30.0, "the lines are there")
        robot, lidar = (
            SerialLine(os.fspath(link), 19_200),
            SerialLine(os.fspath(lidar_link), 230_400),
        )
        robot.write(bytes([128, 142, 35]))
        assert robot.read(10.0) == b"\x01"
        assert HEAD in lidar.read(10.0) + lidar.read(10.0)
        robot.close()
        other = SerialLine(os.fspath(link), 115_200)
        other.write(bytes([142, 35]))
        assert other.read(0.5) == b""
        emulator.send_signal(signal.SIGHUP)  # its terminal is closed
        told, _ = emulator.communicate(timeout=10.0)
    finally:
        emulator.kill()
    assert emulator.returncode == 0
    assert str(link) in told
    assert str(lidar_link) in told
    assert not os.path.lexists(link)
    assert not os.path.lexists(lidar_link)


def test_a_lidar_stands_alone(tmp_path: Path) -> None:
    link = tmp_path / "ld19"
    words = [*EMULATE, "ld19", "--link", str(link)]
    emulator = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    try:
        wait_until(link.is_symlink, 30.0, "the line is there")
        line, reader = SerialLine(os.fspath(link), 230_400), Ld19Frames(LidarConfig(beams=450))
        wait_until(lambda: reader.take(line.read(1.0), time.monotonic()), 10.0, "a scan")
    finally:
        emulator.terminate()
        emulator.communicate(timeout=10.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("neato --home nowhere", "nowhere"),
        ("neato --speed 0", "a number from 0.1 to 20"),
        ("neato --model d9", "expected botvac, xv11"),
        ("other", "invalid choice"),
        ("create2 --baud 9600", "invalid choice"),
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
    for words in ("neato --link", "create2 --lidar-link", "ld19 --link"):
        assert main([*words.split(), str(kept)]) == 2
        assert "a file is there" in capsys.readouterr().err
    assert kept.read_text(encoding="utf-8") == "mine"
