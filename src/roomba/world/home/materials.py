"""What the surfaces of a home look like: a colour and a texture for every material's name.

The layer file of a home, the catalogue of furniture, the plan and the camera all speak of
materials by these names.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, get_args

Texture = Literal["plain", "wood", "fabric", "tile", "stone", "metal", "leaf", "glass"]
TEXTURES: tuple[str, ...] = get_args(Texture)


@dataclass(frozen=True, slots=True)
class Material:
    """The look of a surface: its mean colour in sRGB, 0..255, and the pattern on it."""

    red: int
    green: int
    blue: int
    texture: Texture

    @property
    def rgb(self) -> tuple[int, int, int]:
        """Red, green and blue, 0..255."""
        return self.red, self.green, self.blue


FLOORS: MappingProxyType[str, Material] = MappingProxyType(
    {
        "oak": Material(198, 160, 112, "wood"),
        "walnut": Material(136, 98, 68, "wood"),
        "tile_white": Material(226, 228, 226, "tile"),
        "tile_grey": Material(160, 165, 168, "tile"),
        "tile_terracotta": Material(190, 122, 88, "tile"),
        "stone": Material(178, 172, 160, "stone"),
        "concrete": Material(188, 188, 184, "stone"),
    }
)
"""Floors of rooms."""

CARPETS: MappingProxyType[str, Material] = MappingProxyType(
    {
        "carpet_grey": Material(150, 152, 158, "fabric"),
        "carpet_beige": Material(214, 198, 168, "fabric"),
        "carpet_red": Material(158, 62, 54, "fabric"),
        "carpet_blue": Material(78, 104, 146, "fabric"),
        "carpet_green": Material(104, 130, 98, "fabric"),
        "carpet_dark": Material(84, 80, 80, "fabric"),
    }
)
"""Carpets, which may cover a whole room too."""

SURFACES: MappingProxyType[str, Material] = MappingProxyType(
    {
        "wall": Material(236, 230, 218, "plain"),
        "skirting": Material(248, 248, 244, "plain"),
        "ceiling": Material(246, 246, 242, "plain"),
        "door_frame": Material(248, 246, 240, "plain"),
        "door": Material(226, 214, 194, "wood"),
        "stairs": Material(120, 92, 66, "wood"),
        "station": Material(46, 48, 52, "plain"),
        "station_light": Material(92, 214, 140, "plain"),
        "wood_light": Material(214, 180, 132, "wood"),
        "wood": Material(168, 118, 72, "wood"),
        "wood_dark": Material(96, 64, 44, "wood"),
        "white": Material(240, 240, 238, "plain"),
        "cream": Material(232, 222, 202, "plain"),
        "grey": Material(142, 144, 148, "plain"),
        "black": Material(38, 38, 42, "plain"),
        "red": Material(200, 60, 52, "plain"),
        "orange": Material(230, 140, 50, "plain"),
        "yellow": Material(238, 202, 74, "plain"),
        "green": Material(92, 156, 94, "plain"),
        "blue": Material(66, 118, 184, "plain"),
        "fabric_grey": Material(118, 124, 134, "fabric"),
        "fabric_blue": Material(72, 100, 140, "fabric"),
        "fabric_green": Material(92, 122, 96, "fabric"),
        "fabric_red": Material(168, 74, 62, "fabric"),
        "fabric_beige": Material(206, 188, 158, "fabric"),
        "fabric_mustard": Material(212, 164, 66, "fabric"),
        "linen": Material(244, 240, 230, "fabric"),
        "cardboard": Material(190, 148, 100, "plain"),
        "metal": Material(176, 180, 186, "metal"),
        "metal_dark": Material(74, 78, 84, "metal"),
        "steel": Material(200, 204, 208, "metal"),
        "brass": Material(190, 152, 84, "metal"),
        "ceramic": Material(248, 248, 250, "plain"),
        "worktop": Material(98, 94, 92, "stone"),
        "marble": Material(222, 218, 212, "stone"),
        "glass": Material(190, 216, 224, "glass"),
        "mirror": Material(206, 214, 220, "metal"),
        "plaster": Material(236, 230, 218, "plain"),
        "fabric": Material(150, 140, 128, "fabric"),
        "dark": Material(34, 33, 36, "plain"),
        "shiny": Material(30, 32, 38, "metal"),
        "glass_dark": Material(28, 30, 36, "glass"),
        "screen": Material(20, 24, 32, "glass"),
        "water": Material(170, 210, 226, "glass"),
        "leaf": Material(70, 128, 66, "leaf"),
        "leaf_light": Material(118, 164, 84, "leaf"),
        "soil": Material(82, 62, 48, "stone"),
        "pot": Material(196, 108, 74, "stone"),
        "lamp_shade": Material(252, 236, 190, "fabric"),
    }
)
"""Walls, furniture and things."""

MATERIALS: MappingProxyType[str, Material] = MappingProxyType({**FLOORS, **CARPETS, **SURFACES})
"""Every material by its name."""
