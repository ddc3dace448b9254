"""The layer file of a home: what it may say, each value checked by itself.

All lengths in m, positions in the frame of the map, dirt in g and g/h. A direction is ``east``,
``north``, ``west``, ``south`` or an angle in rad, counter-clockwise from the x axis.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from roomba.world.yaml_file import YamlFile, read_yaml

DIRECTIONS = {"east": 0.0, "north": math.pi / 2.0, "west": math.pi, "south": -math.pi / 2.0}


def _direction(value: Any) -> Any:
    if isinstance(value, str):
        if value not in DIRECTIONS:
            raise ValueError(f"expected one of {', '.join(DIRECTIONS)} or an angle in rad")
        return DIRECTIONS[value]
    return value


def _in_order(corners: list[float]) -> list[float]:
    if not (corners[0] < corners[2] and corners[1] < corners[3]):
        raise ValueError("expected [x_min, y_min, x_max, y_max] with both maxima above the minima")
    return corners


Number = Annotated[float, Field(allow_inf_nan=False)]
Length = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Amount = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Direction = Annotated[Number, BeforeValidator(_direction)]
Name = Annotated[str, Field(min_length=1)]
Corner = Annotated[list[Number], Field(min_length=2, max_length=2)]
Corners = Annotated[list[Number], Field(min_length=4, max_length=4), AfterValidator(_in_order)]


class _Entry(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class StationEntry(_Entry):
    """Where the robot stands when docked, its nose looking at the station along ``facing``."""

    x: Number
    y: Number
    facing: Direction


class RoomEntry(_Entry):
    """A room: its outline, corner by corner, to the middle of its walls."""

    name: Name
    floor: Name = "oak"
    outline: Annotated[list[Corner], Field(min_length=3)]


class SizeEntry(_Entry):
    """Measures that differ from the catalogue's."""

    width: Length | None = None
    depth: Length | None = None
    height: Length | None = None


class FurnitureEntry(_Entry):
    """A piece of the catalogue: the middle of its footprint, and where its front looks."""

    name: Name
    kind: Name
    x: Number
    y: Number
    facing: Direction = 0.0
    size: SizeEntry = SizeEntry()
    material: Name | None = None
    on_map: bool = True


class DoorEntry(_Entry):
    """A door: the opening in the wall."""

    name: Name
    opening: Corners
    open: bool = True


class CarpetEntry(_Entry):
    """A carpet."""

    name: Name
    area: Corners
    material: Name = "carpet_grey"


class DirtSourceEntry(_Entry):
    """A source of dirt: see :class:`roomba.world.home.DirtSource`."""

    name: Name
    x: Number
    y: Number
    radius: Length
    amount: Amount = 0.0
    rate: Amount = 0.0


class Layer(_Entry):
    """A whole layer file; every part may be missing."""

    wall_height: Length = 2.4
    station: StationEntry | None = None
    walls: list[Corners] | None = None
    rooms: list[RoomEntry] = []
    doors: list[DoorEntry] = []
    furniture: list[FurnitureEntry] = []
    carpets: list[CarpetEntry] = []
    stairs: list[Corners] = []
    dirt_sources: list[DirtSourceEntry] | None = None


def read_layer(path: Path) -> tuple[Layer, YamlFile]:
    """Read a layer file, and keep the file for complaints; raises HomeError with the line."""
    file = read_yaml(path)
    layer = file.validated(Layer)
    _refuse_equal_names(layer, file)
    return layer, file


def _refuse_equal_names(layer: Layer, file: YamlFile) -> None:
    for part in ("rooms", "doors", "furniture", "carpets", "dirt_sources"):
        seen: set[str] = set()
        for index, entry in enumerate(getattr(layer, part) or []):
            if entry.name in seen:
                raise file.error(
                    (part, index, "name"),
                    f"{part}: expected every name once, got {entry.name!r} again; rename one",
                )
            seen.add(entry.name)
