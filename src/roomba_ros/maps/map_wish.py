"""Which map the robot shall go by: the values of the parameter ``~map``, or a saved map's name."""

from __future__ import annotations

from pathlib import Path
from typing import Final

GIVEN: Final = "given"
"""A map that another node publishes."""
NONE: Final = "none"
"""A new map that the robot makes."""
OWN: Final = "own"
"""The robot's own map of this floor, recognized among the saved ones."""
FOLDER: Final = "maps"
"""Where saved maps are, unless another folder is given."""


def require_map(wish: str, folder: Path) -> None:
    """Raise MapStoreError where ``folder`` has no map of the name that is wished."""
    if wish in (GIVEN, NONE, OWN):
        return
    # Here: most robots start without, and at once.
    from roomba.storage.map_store import MapStore

    MapStore(folder).require(wish)
