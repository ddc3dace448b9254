"""``python3 -m roomba_ros.supervision.enter COMMAND …``: in the isolated robot's network."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Final

from roomba.errors import RoombaError
from roomba_ros.supervision.isolation import isolated_process
from roomba_ros.supervision.namespace import enter

_NOT_FOUND: Final = 127
"""The exit status for a command that is not there, as in a shell."""


def main(command: Sequence[str]) -> int:
    """Run a command in the isolated robot's network, in place of this process.

    Returns an exit status if that fails.
    """
    try:
        enter(isolated_process())
        os.execvp(command[0], [*command])
    except RoombaError as error:
        print(f"./roomba: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"./roomba: {command[0]}: {error.strerror}", file=sys.stderr)
        return _NOT_FOUND


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
