"""Sets damaged files aside: what they held can be looked at, and the program goes on without."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import Final

_END: Final = ".damaged"
_NO_FILE: Final = (errno.EFBIG, errno.EINVAL, errno.EISDIR, errno.ELOOP)


def is_no_file(error: OSError) -> bool:
    """Whether an error tells of something else in a file's place, or of a file that is too large.

    After any other error the file may be whole, and be read later.
    """
    return error.errno in _NO_FILE


def aside_of(path: Path) -> Path:
    """Return what a damaged file is called once it is set aside."""
    return path.with_name(path.name + _END)


def set_aside(path: Path) -> str:
    """Rename a damaged file, in place of one from before; return what was done, in words."""
    aside = aside_of(path)
    try:
        path.replace(aside)
    except OSError as cause:
        return f"it cannot be set aside: {cause}"
    return f"it is set aside as {aside.name}"
