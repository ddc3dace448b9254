"""The contestants: ours in this process, and peers in processes of their own."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import subprocess
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from roomba_bench.peers.protocol import Parameters, Work, rate

_ALONE = Path(__file__).parent / "peers" / "alone.py"
PREPARE_DEADLINE = 120.0
"""s; the slowest peer builds a graph of some ten thousand cells, or compiles."""
RUN_DEADLINE = 60.0
"""s beyond the time asked for: one unit of work may take longer than that time."""
END_DEADLINE = 2.0


class ContestantError(RuntimeError):
    """A contestant cannot take part; the text says why."""


class Contestant(Protocol):
    """A program that can be measured."""

    @property
    def name(self) -> str:
        """Name in the table."""

    def prepare(self) -> tuple[str, dict[str, float]]:
        """Get ready; return version and facts. Raises ContestantError."""

    def run(self, seconds: float) -> float:
        """Work for so long; return units per second. Raises ContestantError."""

    def end(self) -> None:
        """Let go of everything."""


class Local:
    """A contestant in this process: ours, or a plain reference of our own."""

    def __init__(self, name: str, make: Callable[[], Work], version: str = "") -> None:
        """``make`` is called when it is this contestant's turn to get ready."""
        self.name = name
        self._make = make
        self._version = version
        self._work: Work | None = None

    def prepare(self) -> tuple[str, dict[str, float]]:
        """Make the work and do one batch, so that all is compiled."""
        try:
            self._work = self._make()
            self._work.batch()
        except Exception as error:
            # The measured code may be unfinished: its row says so, and the other rows follow.
            raise ContestantError(f"{type(error).__name__}: {error}") from error
        return self._version, self._work.facts

    def run(self, seconds: float) -> float:
        """Measure."""
        if self._work is None:
            raise ContestantError("expected prepare() before run()")
        return rate(self._work.batch, seconds)

    def end(self) -> None:
        """Drop the work and its arrays."""
        self._work = None


class Program:
    """A process that answers as :mod:`roomba_bench.peers.protocol` says."""

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        parameters: Parameters,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """Start nothing yet; ``environment`` is this process's own by default."""
        self.name = name
        self._command = list(command)
        self._parameters = parameters
        self._environment = dict(os.environ if environment is None else environment)
        self._process: subprocess.Popen[str] | None = None
        self._answers: queue.Queue[str] = queue.Queue()

    def prepare(self) -> tuple[str, dict[str, float]]:
        """Start the process and hand over the case."""
        self._process = subprocess.Popen(
            self._command,
            env=self._environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=None if os.environ.get("BENCH_VERBOSE") else subprocess.DEVNULL,
            text=True,
        )
        threading.Thread(target=self._listen, args=(self._process,), daemon=True).start()
        answer = self._ask({"prepare": self._parameters}, PREPARE_DEADLINE)
        return str(answer["version"]), answer["facts"]

    def run(self, seconds: float) -> float:
        """Ask it to work."""
        return float(self._ask({"run": seconds}, seconds + RUN_DEADLINE)["rate"])

    def end(self) -> None:
        """End the process, by force if it does not obey."""
        if self._process is None:
            return
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        try:
            self._process.wait(END_DEADLINE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process = None

    def _listen(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with process.stdout as lines:
            for line in lines:
                self._answers.put(line)
        self._answers.put("")

    def _ask(self, request: object, deadline: float) -> dict[str, Any]:
        assert self._process is not None
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
            line = self._answers.get(timeout=deadline)
        except queue.Empty:
            raise ContestantError(f"no answer within {deadline:g} s") from None
        except BrokenPipeError:
            line = ""
        if not line:
            raise ContestantError(f"its process ended with status {self._process.wait(5.0)}")
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise ContestantError(str(answer["error"]))
        return answer


class Peer(Program):
    """A peer's script under the peers' own Python; ``module`` is its path below ``peers``."""

    def __init__(
        self,
        python: Path | None,
        name: str,
        module: str,
        parameters: Parameters,
        distribution: str | None = None,
    ) -> None:
        """``python`` is None where no Python of the peers is known.

        ``distribution`` is the peer's name for pip, if it is not ``name``.
        """
        # One core each, as far as peers obey this; and no screen is needed.
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        environment |= {"MUJOCO_GL": "egl", "PYOPENGL_PLATFORM": "egl"}
        command = (str(python), "-I", str(_ALONE), f"roomba_bench.peers.{module}")
        super().__init__(name, command, parameters, environment)
        self._python = python
        self._distribution = distribution or name

    def prepare(self) -> tuple[str, dict[str, float]]:
        """Start the peer if it is installed."""
        if self._python is None:
            has_it = f"one that has {self._distribution}"
            raise ContestantError(f"there is no Python for it; name {has_it}: --peers PYTHON")
        reason = not_installed(self._python, self._distribution)
        if reason:
            raise ContestantError(f"not installed: {reason}")
        return super().prepare()


class Unavailable:
    """A peer that is in the table only with the reason why it is not measured."""

    def __init__(self, python: Path | None, name: str) -> None:
        """Take the peers' Python, and its name for pip."""
        self.name = name
        reason = "" if python is None else not_installed(python, name)
        self._reason = f"not installed: {reason}" if reason else "there is no script for it here"

    def prepare(self) -> tuple[str, dict[str, float]]:
        """Say why not."""
        raise ContestantError(self._reason)

    def run(self, seconds: float) -> float:
        """Say why not."""
        raise ContestantError(self._reason)

    def end(self) -> None:
        """Nothing was begun."""


def not_installed(python: Path, distribution: str) -> str:
    """Return why the set-up did not install a peer; "" if it did, or was not asked to."""
    reason = python.parents[1] / "not-installed" / distribution
    return reason.read_text(encoding="utf-8").strip() if reason.is_file() else ""
