"""Turns the outcome of a command's work into an exit status; an error becomes one printed line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Final

from roomba.commands.options import UsageError
from roomba.commands.process_end import INTERRUPTED, STOPPED
from roomba.errors import RoombaError

COMPLETED: Final = 0
ENDED_OTHERWISE: Final = 1
USAGE: Final = 2
"""Exit status for a command line, or an input, that cannot be used."""


def guarded(
    work: Callable[[], int],
    program: str,
    refused: int = ENDED_OTHERWISE,
    *,
    unfit: tuple[type[RoombaError], ...] = (UsageError,),
    stopped: str = STOPPED,
) -> int:
    """Return the exit status of some work of a ``program``; an error is printed in a line.

    The status is USAGE for errors in ``unfit``, and ``refused`` for other errors of an unusable
    input. ``stopped`` is printed after Ctrl-C. Raises BrokenPipeError, when the reader of the
    output has closed it: that is for :mod:`.process_end`.
    """

    def complain(text: str, status: int) -> int:
        complain_of(program, text)
        return status

    try:
        return work()
    except unfit as error:
        return complain(str(error), USAGE)
    except RoombaError as error:
        return complain(str(error), refused)
    except BrokenPipeError:
        raise
    except OSError as error:
        return complain(f"{error}; choose another file", ENDED_OTHERWISE)
    except KeyboardInterrupt:
        return complain(stopped, INTERRUPTED)


def complain_of(program: str, text: str) -> None:
    """Print in a line what a ``program`` could not do."""
    print(f"{program}: {' '.join(text.split())}", file=sys.stderr)
