"""What surfaces do to a lidar's light, by the names of materials.

A material that is not named here gives back light as the simulation's ``surroundings`` say: by the
place, as every home without materials does. Reflectivities are in the infrared, of matt paint met
squarely; all are assumed.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from types import MappingProxyType
from typing import Final


class Finish(IntEnum):
    """What kind of surface it is; the engine knows it by this number."""

    MATT = 0
    """Gives back its share of the light to all sides."""
    SHINY = 1
    """Gives back all of it where it is met squarely, its matt share elsewhere."""
    GLASS = 2
    """Lets light pass; where it is met squarely a part of the beams comes back."""
    MIRROR = 3
    """Sends light on: the lidar tells the way to what the mirror shows."""
    LOW = 4
    """Lies below the light, which passes over it; a body does not."""


@dataclass(frozen=True, slots=True)
class Surface:
    """A finish, and the share of light that its matt part gives back, 0..1."""

    finish: Finish
    reflectivity: float

    @property
    def is_clear(self) -> bool:
        """Whether a beam goes on from it: glass, mirrors, and what is low."""
        return self.finish in (Finish.GLASS, Finish.MIRROR, Finish.LOW)

    @property
    def code(self) -> int:
        """The surface as a byte of a cell: percent, plus 100 if it is shiny; 0 is for none."""
        return max(1, round(100.0 * self.reflectivity)) + 100 * int(self.finish)


OF_MATERIAL: Final[MappingProxyType[str, Surface]] = MappingProxyType(
    {
        "plaster": Surface(Finish.MATT, 0.85),
        "wood": Surface(Finish.MATT, 0.55),
        "fabric": Surface(Finish.MATT, 0.40),
        "dark": Surface(Finish.MATT, 0.04),
        "metal": Surface(Finish.SHINY, 0.25),
        "shiny": Surface(Finish.SHINY, 0.01),
        "glass": Surface(Finish.GLASS, 0.0),
        "mirror": Surface(Finish.MIRROR, 0.0),
    }
)
"""Surfaces by the material that a layer names."""


LOW: Final = Surface(Finish.LOW, 0.0)
"""The surface of cables and sills."""


def surface_of(material: str | None) -> Surface | None:
    """Return the surface of a material; None for one that has none of its own."""
    return None if material is None else OF_MATERIAL.get(material)
