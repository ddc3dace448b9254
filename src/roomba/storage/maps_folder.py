"""Where the maps lie that a robot without ROS made."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from roomba.files.state_folder import state_folder


def maps_folder(environment: Mapping[str, str] | None = None) -> Path:
    """Return the folder of the maps, which need not be there yet.

    ``$ROOMBA_MAPS``, or ``maps`` in the state folder; a path that is not absolute counts as unset.
    """
    given = os.environ if environment is None else environment
    own = Path(given.get("ROOMBA_MAPS", ""))
    return own if own.is_absolute() else state_folder(given) / "maps"
