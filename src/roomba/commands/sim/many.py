"""Many trials on all cores, in a pool of processes; one that fails is reported by its seed."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Final

from roomba.commands.trials.figures import Figures
from roomba.commands.trials.trial import Trial
from roomba.errors import RoombaError

Outcome = Figures | str
"""The figures of a run, or why there are none."""
Work = Callable[[Trial], Outcome]

LONGEST_RUN: Final = 900.0
"""s without any result; a run that takes longer than that hangs."""


def figures_of(trial: Trial) -> Outcome:
    """Run one trial; an error becomes its text."""
    # Here, so that the parent, which only waits, does not load it all.
    from roomba.commands.trials.runs import run_trial
    from roomba.commands.trials.warm import warm_up

    try:
        warm_up()
        return run_trial(trial).figures
    except RoombaError as error:
        return str(error)
    except Exception as error:  # the other trials go on
        return f"a fault of the program: {error!r}"


def run_many(
    trials: Sequence[Trial],
    work: Work = figures_of,
    processes: int | None = None,
    method: str = "spawn",
) -> Iterator[tuple[Trial, Outcome]]:
    """Yield each trial with what came of it, in the order in which they end.

    Processes that die are replaced; one that hangs for LONGEST_RUN is killed. Closing the iterator
    ends them all. ``method`` is how processes start: spawned ones share nothing with this one,
    whose compiled code may have threads that a fork would lose.
    """
    left = deque(trials)
    count = min(processes or len(os.sched_getaffinity(0)), len(trials))
    with _WorkerPool(work, method) as pool:
        for _ in range(count):
            pool.submit(left.popleft())
        while pool.at_work:
            ended = pool.ended()
            for trial, outcome in ended:
                if left:
                    pool.submit(left.popleft())
                yield trial, outcome


class _WorkerPool:
    """Processes at work; each has one trial at a time. A context: at its end all are gone."""

    def __init__(self, work: Work, method: str) -> None:
        self._work = work
        self._context: Any = multiprocessing.get_context(method)
        self.at_work: dict[Connection, tuple[BaseProcess, Trial]] = {}
        self._idle: list[tuple[Connection, BaseProcess]] = []

    def __enter__(self) -> _WorkerPool:
        return self

    def __exit__(self, *error: object) -> None:
        workers = list(self._idle)
        workers += [(pipe, process) for pipe, (process, _) in self.at_work.items()]
        for process in [process for _, process in workers]:
            process.kill()
        for pipe, process in workers:
            pipe.close()
            process.join(timeout=1.0)

    def submit(self, trial: Trial) -> None:
        """Give a trial to an idle process, or to a new one."""
        pipe, process = self._idle.pop() if self._idle else self._started()
        self.at_work[pipe] = process, trial
        # a process that is gone is found when its answer is read
        with contextlib.suppress(OSError):
            pipe.send(trial)

    def _started(self) -> tuple[Connection, BaseProcess]:
        pipe, other = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(other, self._work), daemon=True)
        with _undisturbed():
            process.start()
            self._idle.append((pipe, process))
        other.close()
        return self._idle.pop()

    def ended(self) -> list[tuple[Trial, Outcome]]:
        """Wait for the next trial that ends; return all that have ended by then."""
        ready = wait(list(self.at_work), timeout=LONGEST_RUN)
        found: list[tuple[Trial, Outcome]] = []
        for pipe in ready or list(self.at_work):
            assert isinstance(pipe, Connection)
            process, trial = self.at_work.pop(pipe)
            try:
                if not ready:
                    raise TimeoutError(f"no result within {LONGEST_RUN:g} s")
                outcome: Outcome = pipe.recv()
                self._idle.append((pipe, process))
            except (EOFError, OSError) as error:
                process.kill()
                process.join(timeout=1.0)
                pipe.close()
                code = "" if process.exitcode is None else f" (status {process.exitcode})"
                outcome = f"its process ended{code}: {error!r}"
            found.append((trial, outcome))
        return found


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """Put off Ctrl-C; processes that are started meanwhile never see it: it is for this one."""
    came = []
    handler = signal.signal(signal.SIGINT, lambda *_: came.append(True))
    # Inherited by what is started; here another thread may get the signal all the same.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, handler)
    if came:
        raise KeyboardInterrupt


def _serve(pipe: Connection, work: Work) -> None:
    """Work off trials until the other end is gone."""
    with contextlib.suppress(EOFError, OSError):
        while True:
            pipe.send(work(pipe.recv()))
