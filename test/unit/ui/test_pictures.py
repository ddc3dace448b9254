"""The picture client: angles in, pictures out, in a window or in a file."""

from __future__ import annotations

import importlib
import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fixtures.typed_answers import TypedAnswers
from numpy.typing import NDArray
from rich.console import Console

from roomba.client.fake.robot import FakeRobot
from roomba.client.protocol import RobotUnavailableError
from roomba.errors import PictureError
from roomba.ui.pictures import (
    PictureViewer,
    ProcessWindow,
    encode_png,
    open_window,
    save_picture,
)

SHAPE = (6, 8)


def small_camera() -> FakeRobot:
    return FakeRobot(picture_shape=SHAPE)


class FakeWindow:
    """Keeps what it is shown; may be broken."""

    def __init__(self, broken: bool = False) -> None:
        self.shown: list[NDArray[np.uint8]] = []
        self.closed = 0
        self._broken = broken

    def show(self, path: Path) -> None:
        if self._broken:
            raise PictureError("the display cannot be opened")
        self.shown.append(load(path))

    def close(self) -> None:
        self.closed += 1


def load(path: Path) -> NDArray[np.uint8]:
    """Read a picture file as RGB."""
    picture: NDArray[np.uint8] = importlib.import_module("cv2").imread(str(path))[..., ::-1]
    return picture


@pytest.fixture(autouse=True)
def no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


def use(
    robot: FakeRobot,
    directory: Path,
    *lines: str | type[BaseException],
    window: FakeWindow | None = None,
) -> tuple[int, list[str], TypedAnswers]:
    """Run a viewer on prepared lines; returns its status, what it printed and what it asked."""
    output = io.StringIO()
    answers = TypedAnswers(lines)
    console = Console(file=output, force_terminal=False)
    viewer = PictureViewer(robot, answers, console, window=window, directories=(directory,))
    return viewer.run(), output.getvalue().splitlines(), answers


def test_without_a_display_the_picture_is_saved_and_its_place_is_told(tmp_path: Path) -> None:
    robot = small_camera()
    status, lines, answers = use(robot, tmp_path, "-15", "12.5", "q", "30")
    assert status == 0
    assert answers.prompts == ["Enter the angle: "] * 3
    for angle, line in zip(("-15", "12.5"), lines, strict=True):
        path = tmp_path / f"roomba_camera_{angle}.png"
        assert line.endswith(f"saved as {path}")
        assert np.array_equal(load(path), robot.picture(float(angle)))
    assert len(list(tmp_path.iterdir())) == 2


def test_with_a_window_nothing_is_saved(tmp_path: Path) -> None:
    robot, window = small_camera(), FakeWindow()
    status, lines, _ = use(robot, tmp_path, "0", "30", window=window)
    assert status == 0
    assert [
        np.array_equal(picture, robot.picture(a))
        for picture, a in zip(window.shown, (0.0, 30.0), strict=True)
    ] == [True, True]
    assert all("in the window" in line for line in lines[:2])
    assert not list(tmp_path.iterdir())
    assert window.closed == 1


def test_a_window_that_fails_is_told_once_and_pictures_are_saved(tmp_path: Path) -> None:
    status, lines, _ = use(small_camera(), tmp_path, "0", "30", window=FakeWindow(broken=True))
    assert status == 0
    assert sum("No window: the display cannot be opened" in line for line in lines) == 1
    assert sum("saved as" in line for line in lines) == 2


@pytest.mark.parametrize("wrong", ["abc", "", "nan", "inf", "-inf", "1e999", "15°", "Q1", "\udcff"])
def test_what_is_no_angle_is_asked_again(wrong: str, tmp_path: Path) -> None:
    status, lines, answers = use(small_camera(), tmp_path, wrong, "q")
    assert status == 0
    assert lines == [f"Expected an angle in degrees, such as -15, or q to leave, got {wrong!a}."]
    assert len(answers.prompts) == 2


@pytest.mark.parametrize("lines", [("q",), (" Q ",), (), ("0",)])
def test_q_and_end_of_input_leave(lines: tuple[str, ...], tmp_path: Path) -> None:
    status, _, answers = use(small_camera(), tmp_path, *lines)
    assert status == 0
    assert len(answers.prompts) == (2 if lines == ("0",) else 1)
    assert "Expected" not in "".join(use(small_camera(), tmp_path, *lines)[1])


def test_ctrl_c_leaves(tmp_path: Path) -> None:
    window = FakeWindow()
    assert use(small_camera(), tmp_path, KeyboardInterrupt, window=window)[0] == 130
    assert window.closed == 1


def test_a_refused_angle_is_told_and_asked_again(tmp_path: Path) -> None:
    status, lines, answers = use(small_camera(), tmp_path, "1e30", "0")
    assert status == 0
    assert lines[0].startswith("The robot refuses: expected an angle")
    assert "saved as" in lines[1]
    assert len(answers.prompts) == 3


def test_no_camera_service_at_all_is_an_error(tmp_path: Path) -> None:
    robot = small_camera()
    robot.camera_answers = False
    status, lines, answers = use(robot, tmp_path, "0", "15")
    assert status == 1
    assert lines[0].startswith("The robot does not answer: no camera service")
    assert len(answers.prompts) == 1
    assert robot.clock.monotonic() <= 5.0


class Flickering(FakeRobot):
    """A camera that is away at the second call only."""

    calls = 0

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        self.calls += 1
        if self.calls == 2:
            raise RobotUnavailableError("away")
        return super().picture(degrees)


@pytest.mark.parametrize("first", ["0", "1e30"])
def test_a_camera_that_answered_once_may_be_asked_again(first: str, tmp_path: Path) -> None:
    robot = Flickering(picture_shape=SHAPE)
    status, lines, _ = use(robot, tmp_path, first, "0", "0")
    assert status == 0
    assert "The robot does not answer: away" in lines
    assert robot.calls == 3


def test_where_no_one_may_write_the_next_directory_is_taken(tmp_path: Path) -> None:
    missing, good = tmp_path / "missing", tmp_path / "good"
    good.mkdir()
    path = save_picture(b"content", -0.0, (missing, good))
    assert path == good / "roomba_camera_0.png"
    assert path.read_bytes() == b"content"
    with pytest.raises(PictureError, match=r"cannot be saved anywhere \(.*missing: No such file"):
        save_picture(b"content", 0.0, (missing,))


def test_a_picture_that_cannot_be_saved_is_told_and_asked_again(tmp_path: Path) -> None:
    status, lines, _ = use(small_camera(), tmp_path / "missing", "0")
    assert status == 0
    assert lines[0].startswith("That did not work: the picture cannot be saved anywhere")


def test_a_broken_write_leaves_the_old_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = save_picture(b"old", 15.0, (tmp_path,))

    def full(_descriptor: int) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(PictureError, match="no space"):
        save_picture(b"new", 15.0, (tmp_path,))
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "picture",
    [
        np.zeros((4, 4), dtype=np.uint8),
        np.zeros((4, 4, 4), dtype=np.uint8),
        np.zeros((0, 4, 3), dtype=np.uint8),
        np.zeros((4, 4, 3), dtype=np.float64),
    ],
)
def test_what_is_no_colour_picture_is_named(picture: NDArray[np.uint8]) -> None:
    with pytest.raises(PictureError, match="expected a picture as uint8"):
        encode_png(picture)


def test_a_window_needs_a_display() -> None:
    assert open_window({}) is None
    assert open_window({"DISPLAY": ""}) is None
    assert open_window({"DISPLAY": ":0"}) is not None
    assert open_window({"WAYLAND_DISPLAY": "wayland-0"}) is not None


@pytest.fixture
def picture_file(tmp_path: Path) -> Path:
    path = tmp_path / "with a space é.png"
    path.write_bytes(encode_png(small_camera().picture(0.0)))
    return path


def test_a_real_window_shows_is_closed_and_opens_again(
    picture_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("QT_QPA_PLATFORM", "offscreen")
    # A busy machine may take long to end a process.
    monkeypatch.setattr("roomba.ui.pictures.CLOSE_DEADLINE", 20.0)
    windows: list[subprocess.Popen[bytes]] = []

    class Noted(subprocess.Popen[bytes]):
        """A process of a window, which is noted down."""

        def __init__(self, *command: Any, **how: Any) -> None:
            super().__init__(*command, **how)
            windows.append(self)

    monkeypatch.setattr(subprocess, "Popen", Noted)
    window = ProcessWindow(deadline=60.0)
    try:
        window.show(picture_file)
        window.show(picture_file)
        (first,) = windows
        assert first.poll() is None
        first.kill()  # as its user closes it
        window.show(picture_file)
    finally:
        window.close()
    _, second = windows
    assert second.poll() == 0  # it left by itself, at the end of its input


def test_a_display_that_cannot_be_opened_is_an_error_not_an_abort(
    picture_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DISPLAY", ":987")
    monkeypatch.delenv("QT_QPA_PLATFORM", raising=False)
    window = ProcessWindow()
    try:
        with pytest.raises(PictureError, match="cannot be opened"):
            window.show(picture_file)
    finally:
        window.close()


def test_a_window_that_hangs_has_a_deadline(
    picture_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sleeper = picture_file.with_name("sleeper")
    sleeper.write_text("#!/bin/sh\nexec sleep 60\n")
    sleeper.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(sleeper))
    window = ProcessWindow(deadline=0.2)
    began = time.monotonic()
    with pytest.raises(PictureError, match=r"within 0\.2 s"):
        window.show(picture_file)
    window.close()
    assert time.monotonic() - began < 5.0


# whole processes

DEADLINE = 20.0
"""s that a process of these tests has for anything; far more than it needs."""
PROMPT = 5.0
"""s of wall time; alone on the machine a tenth of a second."""

PROGRAM = """
import signal, sys
signal.signal(signal.SIGINT, lambda number, frame: None)  # rospy's swallows a Ctrl-C, too
from roomba.client.fake.robot import FakeRobot
from roomba.ui.pictures import PictureViewer
sys.exit(PictureViewer(FakeRobot()).run())
"""


def environment() -> dict[str, str]:
    return dict(os.environ) | {"PYTHONPATH": os.pathsep.join(sys.path)}


def run_on(stdin: bytes, directory: Path, **more: str) -> subprocess.CompletedProcess[bytes]:
    """Run a viewer to its end; in 5 s of it the original wrote half a million lines."""
    return subprocess.run(
        [sys.executable, "-c", PROGRAM],
        input=stdin,
        capture_output=True,
        env=environment() | more,
        cwd=directory,
        timeout=DEADLINE,
        check=False,
    )


@pytest.mark.parametrize("stdin", [b"", b"abc", b"abc\nnan\n", b"\xff\n", b"q\nabc\n"])
def test_end_of_input_ends_and_never_spins(stdin: bytes, tmp_path: Path) -> None:
    done = run_on(stdin, tmp_path)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.count(b"\n") < 10


def test_a_whole_run_saves_here_or_in_the_temporary_directory(tmp_path: Path) -> None:
    here, temporary = tmp_path / "here", tmp_path / "temporary"
    here.mkdir()
    temporary.mkdir()
    done = run_on(b"15\nq\n", here, TMPDIR=str(temporary))
    assert (done.returncode, done.stderr) == (0, b"")
    assert str(here / "roomba_camera_15.png").encode() in done.stdout
    assert load(here / "roomba_camera_15.png").shape == (768, 1024, 3)


def test_a_whole_run_with_a_broken_display_saves(tmp_path: Path) -> None:
    done = run_on(b"15\n", tmp_path, DISPLAY=":987")
    assert done.returncode == 0
    assert b"No window: " in done.stdout
    assert (tmp_path / "roomba_camera_15.png").exists()


def test_real_ctrl_c_leaves_at_once(tmp_path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=environment(),
        cwd=tmp_path,
    ) as process:
        assert process.stdout is not None
        try:
            assert process.stdout.read(len("Enter the angle: ")) == b"Enter the angle: "
            pressed = time.monotonic()
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE) == 130
            assert time.monotonic() - pressed < PROMPT
        finally:
            process.kill()
