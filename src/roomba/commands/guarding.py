"""What comes of a command's work as the exit status of its process: an error is told in a line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Final

from roomba.commands.ending import INTERRUPTED
from roomba.commands.options import UsageError
from roomba.errors import RoombaError

COMPLETED: Final = 0
ENDED_OTHERWISE: Final = 1
USAGE: Final = 2
"""Exit status for a command line, or an input, that cannot be used."""


def guarded(work: Callable[[], int], program: str, refused: int = ENDED_OTHERWISE) -> int:
    """Return the exit status of some work of a ``program``; an error is printed in a line.

    ``refused`` is the status for an input that cannot be used. Raises BrokenPipeError, when the
    reader of the output has closed it: that is for :mod:`.ending`.
    """

    def complain(text: str, status: int) -> int:
        print(f"{program}: {' '.join(text.split())}", file=sys.stderr)
        return status

    try:
        return work()
    except UsageError as error:
        return complain(str(error), USAGE)
    except RoombaError as error:
        return complain(str(error), refused)
    except BrokenPipeError:
        raise
    except OSError as error:
        return complain(f"{error}; choose another file", ENDED_OTHERWISE)
    except KeyboardInterrupt:
        return complain("stopped on the way", INTERRUPTED)
