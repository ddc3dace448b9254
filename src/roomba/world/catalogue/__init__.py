"""The catalogue of furniture by kind; each file has the kinds of one corner of a home."""

from __future__ import annotations

from types import MappingProxyType

from roomba.world.catalogue.bathroom import BATHROOM
from roomba.world.catalogue.cabinets import CABINETS
from roomba.world.catalogue.kitchen import KITCHEN
from roomba.world.catalogue.parts import FurnitureKind, Size
from roomba.world.catalogue.seats import SEATS
from roomba.world.catalogue.things import FIXTURES, LOW_KINDS, THINGS

__all__ = ["FIXTURES", "KINDS", "LOW_KINDS", "FurnitureKind", "Size"]

KINDS: MappingProxyType[str, FurnitureKind] = MappingProxyType(
    {**SEATS, **CABINETS, **KITCHEN, **BATHROOM, **THINGS}
)
"""Every kind by its name."""
