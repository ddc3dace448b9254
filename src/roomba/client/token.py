"""The token of this user's page: a file that programs of the same user read, and no one else."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from roomba.files.state_folder import state_folder

_FORM: Final = re.compile(r"[A-Za-z0-9_-]{22,128}")
"""22 of 64 characters are 132 bits."""


def token_file(environment: Mapping[str, str] | None = None) -> Path:
    """Return where the token is kept: ``$ROOMBA_TOKEN_FILE``, or ``token`` in the state folder."""
    given = os.environ if environment is None else environment
    own = Path(given.get("ROOMBA_TOKEN_FILE", ""))
    return own if own.is_absolute() else state_folder(given) / "token"


def read_token(path: Path | None = None) -> str | None:
    """Return the token; None if there is none, or if other users could read or write it.

    The file must be a regular one of this user, and of mode 0600 or less.
    """
    try:
        flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
        with open(os.open(path or token_file(), flags), encoding="ascii") as file:
            found = os.fstat(file.fileno())
            is_own = stat.S_ISREG(found.st_mode) and found.st_uid == os.geteuid()
            if not is_own or found.st_mode & 0o077:
                return None
            text = file.read(200).strip()
    except (OSError, ValueError):
        return None
    return text if _FORM.fullmatch(text) else None
