"""Processes that measure at the same time, one a core."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from multiprocessing import get_context
from types import TracebackType
from typing import ParamSpec, TypeVar

from roomba.commands.trials.many import undisturbed
from roomba.cores import usable_cores

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")


class Workers(ProcessPoolExecutor):
    """A pool whose processes do not see Ctrl-C: it ends this one, and they end with it."""

    def __init__(self) -> None:
        """Start nothing yet."""
        self._others = set(multiprocessing.active_children())
        # A fork would inherit locks of threads that it does not have.
        super().__init__(usable_cores(), mp_context=get_context("spawn"))

    def submit(
        self,
        fn: Callable[_Arguments, _Result],
        /,
        *args: _Arguments.args,
        **kwargs: _Arguments.kwargs,
    ) -> Future[_Result]:
        """Order some work, from the main thread; processes are started by this."""
        with undisturbed():
            return super().submit(fn, *args, **kwargs)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> bool | None:
        """Wait for all submitted work; after an error in the block, end the processes."""
        if error is not None:
            for process in set(multiprocessing.active_children()) - self._others:
                process.kill()
        return super().__exit__(kind, error, trace)
