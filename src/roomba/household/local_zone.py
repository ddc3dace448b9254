"""The time zone of this computer, by its name."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from roomba.plans.plan import is_zone

_LINK: Final = Path("/etc/localtime")
_FOLDER: Final = "zoneinfo/"
_OTHERWISE: Final = "UTC"


def local_zone(environment: Mapping[str, str] | None = None, link: Path = _LINK) -> str:
    """Return the zone of ``$TZ``, else the one that ``link`` leads to, else UTC."""
    given = os.environ if environment is None else environment
    try:
        linked = os.readlink(link).partition(_FOLDER)[2]
    except OSError:  # no link, or another kind of file: it does not tell its name
        linked = ""
    for name in (given.get("TZ", "").removeprefix(":"), linked):
        if name and is_zone(name):
            return name
    return _OTHERWISE
