"""Why the emergency stop holds the drive, kept on the disk: it holds until a person releases it.

So it outlives a robot whose programs are killed. The file is there while the drive is held; a
file that cannot be read, or is damaged, counts as a hold.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final

from roomba.errors import RoombaError
from roomba.files.bounded import read_bytes
from roomba.files.kept import remove_kept, unsealed, write_kept

FOLDER: Final = "emergency_stop"
"""The name of the folder of these files."""
NO_REASON: Final = "no reason was given"
"""What is kept where none was given."""
_LONGEST: Final = 500
"""Most characters of a reason that are kept."""
_MOST_BYTES: Final = 10_000
"""Most bytes of the file: such a reason, and its seal."""


class KeptStop:
    """The emergency stop of one robot, in a file of its own in ``folder``; of any thread."""

    def __init__(self, folder: Path, robot: str) -> None:
        """Touch nothing yet; ``robot`` is its name, or its namespace."""
        self._path = folder / f"{robot}.txt"
        self._turn = threading.Lock()

    def reason(self) -> str:
        """Return why the drive is to be held from the start on; empty if it is not."""
        try:
            content = unsealed(read_bytes(self._path, _MOST_BYTES))
            reason = " ".join(content.decode().split())
        except (FileNotFoundError, NotADirectoryError):
            return ""
        except (OSError, ValueError, RoombaError) as error:
            return self._damaged(str(error))
        return reason or self._damaged("expected a reason, got none")

    def keep(self, newest: Callable[[], str]) -> str:
        """Keep why the drive is held, or that it is free; return what the disk refused, in words.

        ``newest`` returns the reason, empty if the drive is free. It is called when earlier changes
        are on the disk: of several changes at once the newest one is kept. A refusal of the disk
        changes nothing of what holds now.
        """
        with self._turn:
            reason = newest()
            try:
                if reason:
                    write_kept(self._path, reason[:_LONGEST].encode(errors="replace"))
                elif os.path.lexists(self._path):
                    remove_kept(self._path)
            except OSError as error:
                kept = "it is forgotten" if reason else "it holds again"
                return f"{kept} if the robot is killed, as the disk refused: {error}"
        return ""

    def _damaged(self, trouble: str) -> str:
        return f"it counts as held, as {self._path} is damaged: {trouble}"
