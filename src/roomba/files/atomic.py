"""Files of which whoever reads them finds all, or the one from before, or is told."""

from __future__ import annotations

import os
import zipfile
import zlib
from pathlib import Path
from typing import Final

UNREADABLE: Final = (
    OSError,
    ValueError,
    TypeError,
    KeyError,
    EOFError,
    OverflowError,
    NotImplementedError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading arrays raises that the disk refuses, or that are broken or something else."""


def write_whole(path: Path, content: bytes) -> None:
    """Write a file and the folders that it is in; one that is there is replaced at once, or kept.

    One writer at a time. Raises OSError when the disk refuses.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder: a file can be put in another's place only within one file system.
    unfinished = path.with_name(f"{path.name}.tmp")
    try:
        with unfinished.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise
