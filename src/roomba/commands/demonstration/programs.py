"""The programs of a demonstration: a broker, a made-up robot on its line, and what drives it."""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final
from urllib.parse import urlsplit

from roomba.client.address import HERE
from roomba.errors import RoombaError

START: Final = 120.0
"""s within which a program must have begun; what it needs may have to be compiled first."""
_END: Final = 30.0
"""s within which a program ends that is asked to."""
_PAUSE: Final = 0.1
"""s between two looks."""
_ADDRESS: Final = re.compile(r"http://\S+#token=\S+")


class StartedProgram:
    """A program that runs meanwhile; what it prints goes to a file."""

    def __init__(self, command: Sequence[str], log: Path, environment: Mapping[str, str]) -> None:
        """Start it."""
        self._log = log
        with log.open("wb") as output:
            self._process = subprocess.Popen(
                list(command),
                env=dict(environment),
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )

    @property
    def printed(self) -> str:
        """What it has printed so far."""
        return self._log.read_text("utf-8", errors="replace")

    def await_start(self, has_begun: Callable[[], bool]) -> None:
        """Wait until it has begun; raises RoombaError with what it printed."""
        ends = time.monotonic() + START
        while not has_begun():
            if self._process.poll() is not None or time.monotonic() > ends:
                raise RoombaError(f"expected {self._process.args!r} to begin, got: {self.printed}")
            time.sleep(_PAUSE)

    def end(self) -> None:
        """End the program as background programs are ended."""
        self._process.terminate()
        try:
            self._process.wait(_END)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class RunningPrograms:
    """All that runs in a demonstration; what they keep is in ``folder``."""

    def __init__(self, folder: Path) -> None:
        """Start nothing."""
        self._folder = folder
        self._running: list[StartedProgram] = []

    def start_broker(self) -> int:
        """Start mosquitto for this machine alone; return its port."""
        program = shutil.which("mosquitto", path=f"{os.environ['PATH']}:/usr/sbin")
        if program is None:
            raise RoombaError("expected mosquitto; ./install_dependencies.sh --dev installs it")
        port = free_port()
        settings = self._folder / "mosquitto.conf"
        settings.write_text(f"listener {port} {HERE}\nallow_anonymous true\nuser root\n", "utf-8")
        self._start([program, "-c", str(settings)], "mosquitto", lambda _: answers(port))
        return port

    def start_robot(self, arguments: Sequence[str], links: Sequence[Path]) -> None:
        """Start a made-up robot; it has begun when its lines are there."""
        self._start(
            [sys.executable, "-m", "roomba.commands.program", "emulate", *arguments],
            "emulate",
            lambda _: all(link.exists() for link in links),
        )

    def start_brain(self, arguments: Sequence[str]) -> str:
        """Start what drives it; return the address of its page, with the token."""
        program = self._start(
            [sys.executable, "-m", "roomba.commands.program", "play", *arguments],
            "play",
            is_served,
        )
        found = _ADDRESS.search(program.printed)
        assert found is not None
        return found[0]

    def end(self) -> None:
        """End all, the newest first."""
        while self._running:
            self._running.pop().end()

    def _start(
        self, command: Sequence[str], name: str, has_begun: Callable[[str], bool]
    ) -> StartedProgram:
        program = StartedProgram(
            command, self._folder / f"{name}.log", environment_in(self._folder)
        )
        self._running.append(program)
        program.await_start(lambda: has_begun(program.printed))
        return program


def is_served(printed: str) -> bool:
    """Whether the page answers at the address that was printed, if one was."""
    found = _ADDRESS.search(printed)
    return found is not None and answers(urlsplit(found[0]).port or 0)


def environment_in(folder: Path) -> dict[str, str]:
    """Return an environment in which all that a robot keeps is in a folder, and the zone is UTC."""
    kept = {
        f"ROOMBA_{name.upper()}": str(folder / name) for name in ("maps", "household", "history")
    }
    return {**os.environ, **kept, "ROOMBA_TOKEN_FILE": str(folder / "token"), "TZ": "UTC"}


def free_port() -> int:
    """Return a port of this machine that is free now."""
    with socket.socket() as bound:
        bound.bind((HERE, 0))
        return int(bound.getsockname()[1])


def answers(port: int) -> bool:
    """Whether a server is at a port of this machine."""
    with socket.socket() as tried:
        return tried.connect_ex((HERE, port)) == 0
