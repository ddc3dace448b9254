"""The bits of a cell of a coverage map."""

from __future__ import annotations

from typing import Final

WANTED: Final = 1
"""The cell shall be cleaned."""
SWEPT: Final = 2
"""The tool passed over the cell."""
TRIED: Final = 4
"""The cell was planned while the map was being made: if missed, it waits for the whole map."""
