"""Forks processes from one that has imported all that they need, so that they start quickly."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import signal
import sys
import traceback
from collections.abc import Callable
from typing import Final, NoReturn

_PR_SET_PDEATHSIG: Final = 1
"""Of prctl(2): the signal that a process gets when its parent ends."""
_ENDING: Final = (signal.SIGINT, signal.SIGTERM)


def fork(function: Callable[[], object]) -> int:
    """Run a function in a process of its own group, which ends with this one; return its id.

    Call it from a process of one thread: the child would have the locks of other threads, but not
    the threads. Shared objects are excluded from garbage collection, which writes to each object;
    memory that is written to is copied.
    """
    gc.freeze()
    sys.stdout.flush()
    sys.stderr.flush()
    parent = os.getpid()
    # Block signals until the child has its own handlers; the parent's would take them otherwise.
    signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
    child = os.fork()
    if child:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
        return child
    status = 1
    try:
        end_with(parent, signal.SIGKILL)
        os.setpgid(0, 0)
        for number in _ENDING:
            signal.signal(number, signal.default_int_handler)
        if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
            signal.signal(signal.SIGHUP, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
        function()
        status = 0
    except SystemExit as left:
        status = left.code if isinstance(left.code, int) else 1
    except KeyboardInterrupt:
        pass
    except BaseException:
        _tell_fault()
    finally:
        _leave(status)


def _tell_fault() -> None:
    # A terminal that is lost takes no more lines.
    with contextlib.suppress(OSError):
        traceback.print_exc()


def _leave(status: int) -> NoReturn:
    """End this process; never go on with the parent's work."""
    try:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
    finally:
        os._exit(status)


def end_with(parent: int, number: signal.Signals) -> None:
    """Let this forked process get a signal as soon as its parent ends."""
    if ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, number) != 0:
        raise OSError(ctypes.get_errno(), "expected prctl to let this process end with its parent")
    if os.getppid() != parent:
        # The parent ended before that.
        os._exit(1)


def told_end(status: int) -> str:
    """Return in words how a process ended, by its status of waitpid."""
    code = os.waitstatus_to_exitcode(status)
    if code >= 0:
        return f"ended with status {code}"
    try:
        return f"was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"was ended by signal {-code}"


def is_stopped(pid: int) -> bool:
    """Whether a child process is stopped, by a signal or by a debugger."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as file:
            return file.read().rpartition(")")[2].split()[0] in "tT"
    except OSError:
        return False
