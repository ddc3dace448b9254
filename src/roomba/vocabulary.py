"""The words of a clean, for all that ask for one: programs, the menu, messages, the mission."""

from __future__ import annotations

from enum import Enum


class CleanMode(Enum):
    """What is to be cleaned."""

    WHOLE = "whole"
    """All floor that can be reached."""
    ROOMS = "rooms"
    """Rooms, by name."""
    ZONES = "zones"
    """Rectangles."""
    SPOT = "spot"
    """A square around a point; its size is ``cleaning.spot_size`` of the configuration."""
    EDGES = "edges"
    """Along walls and furniture only."""
    DIRTIEST = "dirtiest"
    """All rooms, those first that were the dirtiest."""


class FanLevel(Enum):
    """The power of the fan; what duty that is stands in the configuration, under ``fan``."""

    QUIET = "quiet"
    STANDARD = "standard"
    STRONG = "strong"
