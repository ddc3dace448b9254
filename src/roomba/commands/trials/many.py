"""Runs much work on all cores, in a pool of processes; one failure does not affect other work."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures import (
    TimeoutError as FutureTimeoutError,  # before 3.11 not the built-in one
)
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import resource_tracker
from typing import Any, Final, TypeAlias, TypeVar

from pebble import ProcessExpired, ProcessPool

from roomba.commands.trials.figures import Figures
from roomba.commands.trials.trial import Trial
from roomba.cores import usable_cores
from roomba.errors import RoombaError

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")
Outcome: TypeAlias = Figures | str
"""The figures of a run, or a text with the reason why there are none."""

LONGEST_RUN: Final = 900.0
"""s; a run that takes longer counts as hanging."""
_LOOK: Final = 1.0
"""s between two looks whether the pool still works."""
_MOST_BROKEN: Final = 3
"""Pools that may break in a row before any work was done."""
_THREADS: Final = (
    "NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
    "OPENCV_FOR_THREADS_NUM",
)  # fmt: skip
"""Environment variables by which libraries choose their number of threads."""


def figures_of(trial: Trial) -> Outcome:
    """Run one trial; an error is returned as its text."""
    # Imported here, so that the parent, which only waits, does not load it all.
    from roomba.commands.trials.runs import run_trial
    from roomba.commands.trials.warm import warm_up

    try:
        warm_up()
        return run_trial(trial).figures
    except RoombaError as error:
        return str(error)
    except (Exception, SystemExit) as error:  # the other trials go on
        return f"a fault of the program: {error!r}"


def run_many(
    items: Sequence[_Item],
    work: Callable[[_Item], _Result],
    processes: int | None = None,
    method: str = "spawn",
) -> Iterator[tuple[_Item, _Result | str]]:
    """Yield each item with what came of it, in the order in which they end.

    If a process died or hung for LONGEST_RUN, the result is a text with the reason, and the process
    is replaced. Closing the iterator ends all processes. ``method`` is how processes start: spawned
    ones share nothing with this process, whose compiled code may have threads that a fork would
    lose.
    """
    left, broken = deque(items), 0
    while left and broken < _MOST_BROKEN:
        with contextlib.closing(_run_in_pool(left, work, processes, method)) as results:
            for item, result in results:
                broken = 0
                yield item, result
        broken += 1
    for item in left:
        yield item, f"processes ended before they did anything, {broken} times"


def _run_in_pool(
    left: deque[_Item], work: Callable[[_Item], _Result], processes: int | None, method: str
) -> Generator[tuple[_Item, _Result | str]]:
    """Run the items left until all are done or the pool breaks; unfinished items are put back.

    A pool breaks when an idle process dies.
    """
    count = min(processes or usable_cores(), len(left))
    others = set(multiprocessing.active_children())
    pool = ProcessPool(count, context=multiprocessing.get_context(method))
    at_work: dict[Future[_Result], _Item] = {}

    def give_one() -> None:
        with contextlib.suppress(RuntimeError):  # the pool broke just now
            at_work[pool.schedule(work, args=(left[0],), timeout=LONGEST_RUN)] = left[0]
            left.popleft()

    with one_thread_each():
        try:
            with undisturbed():
                for _ in range(count):
                    give_one()
            while at_work and pool.active:
                for future in wait(at_work, _LOOK, FIRST_COMPLETED).done:
                    if isinstance(future.exception(), BrokenProcessPool):
                        return
                    item = at_work.pop(future)
                    if left:
                        give_one()
                    yield item, _result_of(future)
        finally:
            left.extendleft(at_work.values())
            pool.stop()
            # A process that is still starting would print a traceback about the lost pool.
            for process in set(multiprocessing.active_children()) - others:
                process.kill()
            pool.join()


def _result_of(future: Future[Any]) -> Any:
    try:
        return future.result()
    except ProcessExpired as error:
        return f"its process ended (status {error.exitcode})"
    except FutureTimeoutError:
        return f"no result within {LONGEST_RUN:g} s"


@contextlib.contextmanager
def one_thread_each() -> Iterator[None]:
    """Let programs that are started meanwhile compute in one thread: each has one core."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Defer Ctrl-C for this process; processes that are started meanwhile never get it."""
    came: list[Any] = []
    # Started now: Python would start it with the first process and unblock the signal.
    resource_tracker.ensure_running()
    handler = signal.signal(signal.SIGINT, lambda *_: came.append(True))
    # Started processes inherit the mask. In this one, another thread may still get the signal.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, handler)
    if came:
        raise KeyboardInterrupt
