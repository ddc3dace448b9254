"""Sets damaged files aside: what they held can be looked at, and the program goes on without."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_END: Final = ".damaged"


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
