"""Where what belongs to a household lives, and how it is read and written."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final, TypeVar

from roomba.configuration.frozen import Frozen, validated
from roomba.errors import RoombaError
from roomba.files.kept import UnreadFileError, read_kept, write_kept
from roomba.files.plain_json import load_json
from roomba.files.state_folder import state_folder

_MOST_BYTES: Final = 4_000_000
"""Of a file; a household has some kilobytes."""

_Kept = TypeVar("_Kept", bound=Frozen)
Tell = Callable[[str], object]
"""Is told what went wrong with the disk, in a sentence."""


def household_folder(environment: Mapping[str, str] | None = None) -> Path:
    """Return the folder of the household, which need not be there yet.

    ``$ROOMBA_HOUSEHOLD``, or ``household`` in the state folder; a path that is not absolute counts
    as unset.
    """
    given = os.environ if environment is None else environment
    own = Path(given.get("ROOMBA_HOUSEHOLD", ""))
    return own if own.is_absolute() else state_folder(given) / "household"


class KeptValues:
    """Values of one model in one file; for a damaged file the one before is read, and that is told.

    A file that the disk refuses, or that a newer program wrote, is not written over.
    """

    def __init__(self, path: Path, tell: Tell) -> None:
        """Touch nothing yet."""
        self._path, self._tell = path, tell
        self._unread: UnreadFileError | None = None

    def read(self, otherwise: _Kept) -> _Kept:
        """Return what was kept, of the model of ``otherwise``; that itself if none can be read."""

        def parse(content: bytes) -> _Kept:
            return validated(type(otherwise), load_json(content.decode("utf-8")), "")

        self._unread = None
        try:
            found = read_kept(self._path, parse, self._tell, most=_MOST_BYTES)
        except UnreadFileError as error:
            self._unread = error
            self._tell(f"{error}; until this program is started again nothing is kept there")
            return otherwise
        except RoombaError as error:
            self._tell(f"{error}; it begins anew")
            found = None
        return otherwise if found is None else found

    def write(self, values: Frozen) -> None:
        """Keep values; raises OSError when the disk refuses, or they are too many to be read again.

        It raises OSError, too, where :meth:`read` could not read what is there.
        """
        if self._unread is not None:
            raise OSError(errno.EPERM, f"not kept: {self._unread}")
        text = json.dumps(values.model_dump(mode="json"), indent=1, allow_nan=False)
        write_kept(self._path, text.encode() + b"\n", most=_MOST_BYTES)
