"""Ends a command's process without a traceback when its reader or its user has had enough.

It imports the standard library alone, since ``./roomba doctor`` must work when nothing is set up.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
import signal
import sys
from collections.abc import Iterator
from typing import Final

FAILED: Final = 1
"""Exit status when the output's reader is gone, or disk or memory is full."""
INTERRUPTED: Final = 130
"""Exit status after Ctrl-C."""
_STANDARD_ERROR: Final = 2
STOPPED: Final = "stopped on the way"
"""The text that is printed after Ctrl-C."""
_FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Error numbers of a disk or file that takes no more."""


def ending_signals() -> tuple[signal.Signals, ...]:
    """Return the signals that end a program; under ``nohup`` a lost terminal does not."""
    told = (signal.SIGINT, signal.SIGTERM)
    is_kept = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    return told if is_kept else (*told, signal.SIGHUP)


@contextlib.contextmanager
def quiet_end() -> Iterator[None]:
    """End the process in order if its output is closed, or Ctrl-C comes, while this goes on."""
    try:
        with _flushed_output():
            yield
    except BrokenPipeError:
        _give_output_up()
        sys.exit(FAILED)
    except OSError as error:
        if error.errno not in _FULL:
            raise
        _give_output_up()
        print(f"expected room for what is written: {error}; make some", file=sys.stderr)
        sys.exit(FAILED)
    except MemoryError:
        print("expected more memory than there is; end other programs", file=sys.stderr)
        sys.exit(FAILED)
    except KeyboardInterrupt:
        print(STOPPED, file=sys.stderr)
        sys.exit(INTERRUPTED)


@contextlib.contextmanager
def quiet_loading() -> Iterator[None]:
    """End the process at once if Ctrl-C comes while modules are imported, which takes a second.

    There is nothing to clean up yet, and compiled modules turn an interrupt into an ImportError. If
    Ctrl-C was ignored before, it stays so.
    """
    before = signal.getsignal(signal.SIGINT)
    if before is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _leave(*_: object) -> None:
    os.write(_STANDARD_ERROR, f"{STOPPED}\n".encode())
    os._exit(INTERRUPTED)


@contextlib.contextmanager
def _flushed_output() -> Iterator[None]:
    """Write all printed text at the end, also that of a parser that ends the process.

    Characters that the output's encoding lacks, such as m² in ASCII, become ``?``.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    try:
        yield
    finally:
        if sys.stdout is not None:  # None if a shell closed it by >&-
            sys.stdout.flush()


def _give_output_up() -> None:
    """Drop what is still to be written: Python would try to write it at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
