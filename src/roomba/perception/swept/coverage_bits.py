"""The bits of a cell of a coverage map."""

from __future__ import annotations

from typing import Final

WANTED: Final = 1
"""It shall be cleaned."""
SWEPT: Final = 2
"""The tool passed over it."""
TRIED: Final = 4
"""Planned already while the map is being made: what is left of it waits for the whole map."""
