"""How much room is left on the disk of a folder."""

from __future__ import annotations

import errno
import os
from pathlib import Path


def require_free_space(folder: Path, least: float) -> None:
    """Raise OSError (ENOSPC) when less than ``least`` bytes are free for files in ``folder``.

    The folder need not be there yet. A full disk may take small files for a long time, in the place
    of those that they replace, and refuse larger ones: the free space shows that at once.
    """
    there = next(place for place in (folder, *folder.parents) if place.exists())
    disk = os.statvfs(there)
    free = disk.f_bavail * disk.f_frsize
    if free < least:
        problem = f"{free / 1e6:.1f} MB are free, {least / 1e6:g} MB are needed"
    elif disk.f_files and not disk.f_favail:
        problem = "no more files can be made"
    else:
        return
    full = f"{os.strerror(errno.ENOSPC)}: {problem}; make room"
    raise OSError(errno.ENOSPC, full, str(there))
