"""The picture client: asks for angles and shows what the robot's camera saw.

The window lives in a process of its own (this file run as a program), for two reasons: it stays
alive while the prompt waits, and a display that cannot be opened ends that process alone (Qt
aborts without asking).
"""

from __future__ import annotations

import contextlib
import importlib
import os
import select
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from roomba.client.protocol import CameraClient, RobotUnavailableError
from roomba.errors import PictureError, RoombaError
from roomba.files.atomic import write_whole
from roomba.ui.desktop import names_screen
from roomba.ui.progress import say
from roomba.ui.prompt import (
    STATUS_DONE,
    STATUS_INTERRUPTED,
    EndOfInputError,
    Interrupts,
    Keyboard,
    Read,
    ask,
    explain,
    read_number,
)

STATUS_UNAVAILABLE = 1

WINDOW_TITLE = "roomba camera"
WINDOW_DEADLINE = 10.0
"""s for a window to appear; a cold import of OpenCV on a small machine takes some of them."""
CLOSE_DEADLINE = 1.0
LEAVE_KEYS = (ord("q"), 27)
"""Keys that close the window: q and Escape."""
EVENT_TIME = 30
"""ms between two looks at the window's events."""


class Window(Protocol):
    """Somewhere to show a picture file."""

    def show(self, path: Path) -> None:
        """Show a picture in place of the last one; raises PictureError."""

    def close(self) -> None:
        """Take the window away."""


class PictureViewer:
    """The prompt for pictures; without a ``window``, or when it fails, pictures are saved.

    ``directories`` are tried in their order: by default the current and the temporary one.
    """

    def __init__(
        self,
        camera: CameraClient,
        read: Read | None = None,
        console: Console | None = None,
        *,
        window: Window | None = None,
        directories: tuple[Path, ...] | None = None,
    ) -> None:
        self._camera = camera
        self._read = Keyboard() if read is None else read
        self._console = Console() if console is None else console
        self._window = open_window() if window is None else window
        self._directories = directories
        self._answered = False

    def run(self) -> int:
        """Ask until ``q`` or the end of input (0), Ctrl-C (130) or no camera at all (1)."""
        with Interrupts():
            try:
                return self._serve()
            except EndOfInputError:
                self._say("")
                return STATUS_DONE
            except KeyboardInterrupt:
                self._say("")
                return STATUS_INTERRUPTED
            finally:
                self._close_window()

    def _serve(self) -> int:
        while (text := ask(self._read, "Enter the angle: ")).lower() != "q":
            degrees = read_number(text)
            if degrees is None:
                expected = "an angle in degrees, such as -15, or q to leave"
                self._complain(f"Expected {expected}, got {text!a}.")
                continue
            try:
                picture = self._camera.picture(degrees)
                self._answered = True
                self._present(picture, degrees)
            except RoombaError as error:
                self._complain(explain(error))
                unavailable = isinstance(error, RobotUnavailableError)
                if unavailable and not self._answered:
                    return STATUS_UNAVAILABLE
                self._answered = self._answered or not unavailable
        return STATUS_DONE

    def _present(self, picture: NDArray[np.uint8], degrees: float) -> None:
        image = encode_png(picture)
        if self._window is not None:
            try:
                with tempfile.TemporaryDirectory(prefix="roomba_camera_") as directory:
                    shown = Path(directory) / "shown.png"
                    write_whole(shown, image)
                    self._window.show(shown)
            except (OSError, PictureError) as error:
                self._complain(f"No window: {error}. Pictures are saved instead.")
                self._close_window()
            else:
                self._say(f"The picture nearest to {degrees:g} degrees is in the window.")
                return
        path = save_picture(image, degrees, self._directories or default_directories())
        self._say(f"The picture nearest to {degrees:g} degrees is saved as {path}")

    def _close_window(self) -> None:
        if self._window is not None:
            self._window.close()
            self._window = None

    def _complain(self, text: str) -> None:
        self._say(text, style="red")

    def _say(self, text: str, style: str | None = None) -> None:
        say(self._console, text, style)


def encode_png(picture: NDArray[np.uint8]) -> bytes:
    """Return a PNG file's content; ``picture`` is uint8 [height, width, 3] RGB."""
    if picture.dtype != np.uint8 or picture.ndim != 3 or picture.shape[2] != 3 or not picture.size:
        got = f"{picture.dtype} {list(picture.shape)}"
        raise PictureError(f"expected a picture as uint8 [height, width, 3], got {got}")
    done, image = _opencv().imencode(".png", picture[..., ::-1])  # OpenCV's order is blue first
    if not done:
        raise PictureError("the picture cannot be encoded as PNG")
    return bytes(image)


def default_directories() -> tuple[Path, ...]:
    """Where pictures are saved: in the current folder, or in the temporary one."""
    return Path.cwd(), Path(tempfile.gettempdir())


def save_picture(image: bytes, degrees: float, directories: tuple[Path, ...]) -> Path:
    """Save as ``roomba_camera_<angle>.png`` in the first directory that can be written.

    Raises :class:`PictureError` with each directory's reason.
    """
    reasons = []
    for directory in directories:
        # adding 0.0 turns -0.0 into 0.0
        path = directory / f"roomba_camera_{degrees + 0.0:g}.png"
        try:
            # Raises OSError for a directory that is missing: a new one would be a surprise.
            directory.stat()
            write_whole(path, image)
        except OSError as error:
            reasons.append(f"{directory}: {error.strerror or error}")
        else:
            return path
    raise PictureError(f"the picture cannot be saved anywhere ({'; '.join(reasons)})")


def open_window(environment: Mapping[str, str] = os.environ) -> Window | None:
    """Return a window to be shown at the first picture, or None without a display."""
    return ProcessWindow() if names_screen(environment) else None


class ProcessWindow:
    """A window in a process of its own, started at the first picture; closed, it starts again."""

    def __init__(self, deadline: float = WINDOW_DEADLINE) -> None:
        self._deadline = deadline
        self._process: subprocess.Popen[bytes] | None = None

    def show(self, path: Path) -> None:
        """Show a picture file; raises PictureError if it is not seen within the deadline."""
        if self._process is not None:
            try:
                self._hand_over(self._process, path)
                return
            except PictureError:
                self.close()  # its user closed it: a new one is wanted now
        self._process = self._start()
        self._hand_over(self._process, path)

    def _hand_over(self, process: subprocess.Popen[bytes], path: Path) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(os.fsencode(path) + b"\n")
            process.stdin.flush()
        except OSError as error:
            raise PictureError("it was closed") from error
        ready, _, _ = select.select([process.stdout], [], [], self._deadline)
        if not ready:
            raise PictureError(f"it did not appear within {self._deadline:g} s")
        if not process.stdout.read(1):
            raise PictureError("the display cannot be opened")

    def close(self) -> None:
        """End the window's process, if there is one."""
        if self._process is None:
            return
        process, self._process = self._process, None
        assert process.stdin is not None
        assert process.stdout is not None
        with contextlib.suppress(OSError):
            process.stdin.close()  # the end of its input is its sign to leave
        try:
            process.wait(CLOSE_DEADLINE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        process.stdout.close()

    def _start(self) -> subprocess.Popen[bytes]:
        # it must find this package wherever this process found it
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path), PYTHONSAFEPATH="1")
        try:
            return subprocess.Popen(
                [sys.executable, "-m", "roomba.ui.pictures"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,  # Qt's chatter would stand in the prompt
                bufsize=0,
                env=environment,
                start_new_session=True,  # Ctrl-C is for the prompt
            )
        except OSError as error:
            raise PictureError(f"its process cannot be started: {error}") from error


def serve_window() -> None:
    """Show the picture files named on stdin, answering each, until its end or a closed window."""
    cv2 = _opencv()
    cv2.namedWindow(WINDOW_TITLE, cv2.WINDOW_NORMAL)
    shown = False
    while True:
        if select.select([sys.stdin], [], [], 0.0)[0]:
            line = sys.stdin.buffer.readline()
            if not line:
                return
            cv2.imshow(WINDOW_TITLE, cv2.imread(os.fsdecode(line.rstrip(b"\n"))))
            cv2.waitKey(1)
            shown = True
            os.write(sys.stdout.fileno(), b".")
        key = cv2.waitKey(EVENT_TIME)  # also what paces this loop
        closed = cv2.getWindowProperty(WINDOW_TITLE, cv2.WND_PROP_VISIBLE) < 1.0
        if shown and (closed or key in LEAVE_KEYS):
            return


def _opencv() -> Any:
    """Import OpenCV at its first use: it takes a second, and the prompt should not wait for it."""
    return importlib.import_module("cv2")


if __name__ == "__main__":
    serve_window()
