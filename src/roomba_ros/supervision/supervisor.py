"""Starts the robot's processes, watches them, restarts those that end or hang, and ends all.

It has one thread and no ROS connections, so nothing on the graph can hold it up.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import selectors
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from roomba.configuration.nodes import SupervisionConfig
from roomba_ros.runtime.timing.heart import HEART
from roomba_ros.supervision.fork import fork, is_stopped, told_end
from roomba_ros.supervision.watch import Watch

_LOOK: Final = 0.05
"""s of wall time between two looks at the processes."""
_SIGNALS: Final = ((signal.SIGINT, 1.8), (signal.SIGTERM, 0.6), (signal.SIGKILL, 5.0))
"""The signals that end processes, each with s of wall time until the next, stronger one."""


@dataclass(slots=True)
class _Process:
    """One process: what it does, how it is, its id and the pipe of its signs of life."""

    run: Callable[[], object]
    watch: Watch
    is_required: bool = False
    is_kept: bool = True
    pid: int = 0
    heart: int = -1


class Supervisor:
    """Watches processes; they end with it, also when it is killed."""

    def __init__(self, config: SupervisionConfig) -> None:
        """Start nothing yet; from now on a signal only says that it is to end."""
        self._config = config
        self._processes: list[_Process] = []
        self._master: Watch | None = None
        self._selector = selectors.DefaultSelector()
        self._told: dict[str, str] = {}
        self._face: tuple[int, int] | None = None
        self._status: int | None = None
        for number in _told_by():
            signal.signal(number, lambda *_: self._end(0))

    @property
    def is_ending(self) -> bool:
        """Whether it was told to end."""
        return self._status is not None

    def add(
        self,
        name: str,
        run: Callable[[], object],
        *,
        is_required: bool = False,
        is_kept: bool = True,
        is_master: bool = False,
    ) -> None:
        """Start a process, unless all are to end, and watch it; a required process ends all.

        A process that is not ``is_kept``, such as a window that the user closes, may end and is
        forgotten then. A life in which the master (``is_master``) was not up all the time does not
        count against a process.
        """
        process = _Process(run, Watch(name, self._config), is_required, is_kept)
        if is_master:
            self._master = process.watch
        self._processes.append(process)
        if not self.is_ending:
            self._start(process)

    def tell_to(self) -> int:
        """Return the reading end of a pipe: for each change a line of JSON, troubles by process.

        A restarted reader gets the same pipe.
        """
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        self._face = (reading, writing)
        return reading

    def run(self) -> int:
        """Watch until a signal, or until a required process ended; return the exit status."""
        while self._status is None:
            self._hear()
            now = time.monotonic()
            self._reap(now)
            for process in self._processes:
                self._look_after(process, now)
            self._tell(now)
        self.end_all()
        return self._status

    def end_all(self) -> None:
        """End all processes together, and then the first one, which is the master."""
        for number in _told_by():
            signal.signal(number, signal.SIG_IGN)
        nodes, first = self._processes[1:], self._processes[:1]
        for processes in (nodes, first):
            for number, patience in _SIGNALS:
                there = [process for process in processes if process.watch.is_running]
                for process in there:
                    if number is not signal.SIGINT:
                        _say(f"{process.watch.name} has not ended yet: {number.name}")
                    os.kill(process.pid, number)
                    os.kill(process.pid, signal.SIGCONT)
                deadline = time.monotonic() + patience
                while there and time.monotonic() < deadline:
                    there = [process for process in there if not self._has_ended(process)]
                    time.sleep(0.005)

    def _end(self, status: int) -> None:
        if self._status is None:
            self._status = status

    def _start(self, process: _Process) -> None:
        self._forget_heart(process)
        process.heart, writing = os.pipe()
        for end in (process.heart, writing):
            os.set_blocking(end, False)
            fcntl.fcntl(end, fcntl.F_SETFD, fcntl.FD_CLOEXEC)

        def run() -> None:
            HEART.use(writing)
            process.run()

        process.pid = fork(run)
        os.close(writing)
        self._selector.register(process.heart, selectors.EVENT_READ, process)
        process.watch.started(time.monotonic())
        _say(f"{process.watch.name}: started, process {process.pid}")

    def _forget_heart(self, process: _Process) -> None:
        if process.heart >= 0:
            with contextlib.suppress(KeyError):
                self._selector.unregister(process.heart)
            os.close(process.heart)

    def _hear(self) -> None:
        """Wait a moment for signs of life, and take those that come."""
        for key, _ in self._selector.select(_LOOK):
            with contextlib.suppress(BlockingIOError):
                if os.read(key.fd, 1 << 12):
                    key.data.watch.beat(time.monotonic())
                else:
                    # The process ended, as waitpid tells, or became a program that sends no such
                    # signs.
                    # The end of the closed pipe would be reported for ever.
                    self._selector.unregister(key.fd)
                    if key.data.watch.is_running:
                        key.data.watch.has_no_heart()

    def _reap(self, now: float) -> None:
        for process in self._processes.copy():
            if not process.watch.is_running:
                continue
            pid, status = os.waitpid(process.pid, os.WNOHANG)
            if not pid:
                continue
            how = told_end(status)
            process.watch.ended(now, how, counts=self._had_master(process.watch))
            _say(f"{process.watch.name} {how}")
            if not process.is_kept:
                self._forget_heart(process)
                self._processes.remove(process)
            if process.is_required or (process.watch.is_given_up and process is self._processes[0]):
                _say(f"{process.watch.name} is needed by all others: they end")
                self._end(max(1, os.waitstatus_to_exitcode(status)))

    def _had_master(self, watch: Watch) -> bool:
        """Whether the master was up for a process's whole life, or is that process."""
        master = self._master
        return master is None or master is watch or master.up_since <= watch.started_at

    def _look_after(self, process: _Process, now: float) -> None:
        watch = process.watch
        if watch.is_running:
            watch.seen(now, is_stopped=is_stopped(process.pid))
            if watch.wants_end(now):
                _say(f"{watch.trouble(now)}: it is ended")
                os.kill(process.pid, signal.SIGKILL)
        elif watch.wants_start(now) and self._status is None:
            self._start(process)

    def _tell(self, now: float) -> None:
        """Report what is wrong, if that changed."""
        states = {process.watch.name: process.watch.trouble(now) for process in self._processes}
        if states == self._told:
            return
        for name, said in states.items():
            if said and said != self._told.get(name):
                _say(said)
        self._told = states
        if self._face is not None:
            # The pipe is full while its reader hangs; a restarted reader gets the next line.
            with contextlib.suppress(BlockingIOError):
                os.write(self._face[1], json.dumps(states).encode() + b"\n")

    def _has_ended(self, process: _Process) -> bool:
        if os.waitpid(process.pid, os.WNOHANG)[0]:
            process.watch.is_running = False
        return not process.watch.is_running


def _told_by() -> tuple[signal.Signals, ...]:
    """Return the signals that end the supervisor; under ``nohup`` a lost terminal does not."""
    told = (signal.SIGINT, signal.SIGTERM)
    is_kept = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return told if is_kept else (*told, signal.SIGHUP)


def _say(line: str) -> None:
    # A lost terminal takes no more lines; that must not end the supervisor.
    with contextlib.suppress(OSError):
        print(f"[supervisor] {line}", file=sys.stderr, flush=True)
