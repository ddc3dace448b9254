"""Which files a home has, and its layer file: what it may say, each value checked by itself.

All lengths in m, positions in the frame of the map, dirt in g and g/h. A direction is ``east``,
``north``, ``west``, ``south`` or an angle in rad, counter-clockwise from the x axis. Times in s.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    field_validator,
    model_validator,
)

from roomba.errors import HomeError
from roomba.files.strict_yaml import YamlFile, read_yaml, suggestion
from roomba.vocabulary import LONGEST_NAME, fault_of_name

MAP_NAME: Final = "map.yaml"
LAYER_NAME: Final = "home.yaml"
"""The files of a home's folder: a map_server map, and the layer beside it."""

DAY: Final = 86_400.0
"""s; the longest script of what moves: an occurrence that would end later does not begin."""

DIRECTIONS = {"east": 0.0, "north": math.pi / 2.0, "west": math.pi, "south": -math.pi / 2.0}

SHORTEST_PERIOD: Final = 10.0
"""s; the shortest period: with 0 the day's track would be endless."""


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


def _from_until(interval: list[float]) -> list[float]:
    if not interval[0] < interval[1]:
        raise ValueError("expected [from, until] with the first before the second")
    return interval


def _is_name(name: str) -> str:
    if fault_of_name(name):
        raise ValueError(f"expected a name of 1 to {LONGEST_NAME} printable characters")
    return name


Number = Annotated[float, Field(allow_inf_nan=False)]
Length = Annotated[float, Field(ge=0.001, le=10_000.0)]
"""m; also m/s of a person and s of a move: no home has any that is shorter or longer."""
Side = Annotated[float, Field(ge=0.001, le=20.0)]
"""m; of a piece of furniture, and the height of a wall: a shelf gets books by its size."""
Amount = Annotated[float, Field(ge=0.0, le=1_000_000.0)]
"""g; what the floor can hold is less: see :mod:`roomba.world.layers.layer`."""
Direction = Annotated[Number, BeforeValidator(_direction)]
Name = Annotated[str, AfterValidator(_is_name)]
Corner = Annotated[list[Number], Field(min_length=2, max_length=2)]
Corners = Annotated[list[Number], Field(min_length=4, max_length=4), AfterValidator(_in_order)]
Time = Annotated[float, Field(ge=0.0, le=DAY)]
Interval = Annotated[list[Time], Field(min_length=2, max_length=2), AfterValidator(_from_until)]


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

    width: Side | None = None
    depth: Side | None = None
    height: Side | None = None


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


class ArcEntry(_Entry):
    """A part of a circle, counter-clockwise ``from`` one direction ``to`` another, rad."""

    centre: Corner
    radius: Length
    first: Annotated[Number, Field(alias="from")]
    last: Annotated[Number, Field(alias="to")]

    @model_validator(mode="after")
    def _goes_round_once(self) -> ArcEntry:
        if not 0.0 < self.last - self.first < 2.0 * math.pi:
            raise ValueError("expected 'to' above 'from' by less than a turn (6.28 rad)")
        return self


class WallEntry(_Entry):
    """A wall of a form or a material of its own: exactly one of area, line and arc.

    An ``area`` is a rectangle along the axes. A wall along a ``line`` or ``arc``, which is its
    middle, is ``thickness`` m wide and stands where it is told, off the grid.
    """

    area: Corners | None = None
    line: Annotated[list[Corner], Field(min_length=2)] | None = None
    arc: ArcEntry | None = None
    thickness: Length | None = None
    material: Name | None = None
    on_map: bool = True

    @field_validator("line")
    @classmethod
    def _leads_on(cls, line: list[list[float]] | None) -> list[list[float]] | None:
        if line is not None and any(before == after for before, after in pairwise(line)):
            raise ValueError("expected points each another than the one before")
        return line

    @model_validator(mode="after")
    def _has_one_form(self) -> WallEntry:
        forms = [name for name in ("area", "line", "arc") if getattr(self, name) is not None]
        if len(forms) != 1:
            raise ValueError("expected exactly one of the keys area, line, arc")
        if (self.thickness is None) != (self.area is not None):
            raise ValueError("expected 'thickness' beside line or arc, and only there")
        if self.area is not None and not self.on_map:
            raise ValueError("expected 'on_map' beside line or arc: an area is drawn on the map")
        if self.arc is not None and (self.thickness or 0.0) >= 2.0 * self.arc.radius:
            raise ValueError("expected a thickness below twice the radius")
        return self


def _wall(value: Any) -> Any:
    return {"area": value} if isinstance(value, list) else value


class CarpetEntry(_Entry):
    """A carpet."""

    name: Name
    area: Corners
    material: Name = "carpet_grey"


class DirtSourceEntry(_Entry):
    """A source of dirt: see :class:`roomba.world.home.home.DirtSource`."""

    name: Name
    x: Number
    y: Number
    radius: Length
    amount: Amount = 0.0
    rate: Annotated[float, Field(ge=0.0, le=10_000.0)] = 0.0


class PlaceEntry(_Entry):
    """Where a piece of furniture is moved to: it slides there in ``takes`` s from ``at`` on."""

    at: Time
    x: Number
    y: Number
    facing: Direction | None = None
    takes: Length


class MovingEntry(_Entry):
    """What moves: a door, a piece of furniture or a person, each with keys of its own.

    Times count from the start of the day and of each period, which is ``every`` s long; with 0 all
    happens once. Each occurrence begins up to ``jitter`` s later.
    """

    door: Name | None = None
    close: list[Interval] = []
    furniture: Name | None = None
    to: list[PlaceEntry] = []
    person: Name | None = None
    path: list[Corner] = []
    speed: Length = 0.8
    at: Time = 0.0
    every: Time = 0.0
    jitter: Time = 0.0

    @field_validator("close")
    @classmethod
    def _one_after_the_other(cls, intervals: list[list[float]]) -> list[list[float]]:
        for before, after in pairwise(intervals):
            if after[0] < before[1]:
                raise ValueError("expected intervals in order, each after the one before")
        return intervals

    @field_validator("to")
    @classmethod
    def _one_by_one(cls, places: list[PlaceEntry]) -> list[PlaceEntry]:
        for before, after in pairwise(places):
            if after.at < before.at + before.takes:
                raise ValueError("expected places in order, each after the one before is reached")
        return places

    @field_validator("path")
    @classmethod
    def _leads_somewhere(cls, path: list[list[float]]) -> list[list[float]]:
        if len(path) < 2 or any(before == after for before, after in pairwise(path)):
            raise ValueError("expected 2 points or more, each another than the one before")
        return path

    @field_validator("every")
    @classmethod
    def _once_or_now_and_then(cls, every: float) -> float:
        if 0.0 < every < SHORTEST_PERIOD:
            raise ValueError(f"expected 0 (once) or {SHORTEST_PERIOD:g} s or more")
        return every

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> MovingEntry:
        kinds = [kind for kind in MOVING_KEYS if getattr(self, kind) is not None]
        if len(kinds) != 1:
            raise ValueError(f"expected exactly one of the keys {', '.join(MOVING_KEYS)}")
        needed, *others = MOVING_KEYS[kinds[0]]
        if not getattr(self, needed):
            raise ValueError(f"expected {needed!r} beside {kinds[0]!r}")
        foreign = self.model_fields_set - {kinds[0], needed, *others, "every", "jitter"}
        if foreign:
            raise ValueError(f"expected no {min(foreign)!r} beside {kinds[0]!r}")
        return self


MOVING_KEYS: Final = {
    "door": ("close",),
    "furniture": ("to",),
    "person": ("path", "speed", "at"),
}
"""The keys of what moves, by its kind; the first is needed."""


class Layer(_Entry):
    """A whole layer file; every part may be missing."""

    wall_height: Side = 2.4
    station: StationEntry | None = None
    walls: list[Annotated[WallEntry, BeforeValidator(_wall)]] | None = None
    rooms: list[RoomEntry] = []
    doors: list[DoorEntry] = []
    furniture: list[FurnitureEntry] = []
    carpets: list[CarpetEntry] = []
    stairs: list[Corners] = []
    dirt_sources: list[DirtSourceEntry] | None = None
    moving: list[MovingEntry] = []


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


def list_homes(directory: Path) -> list[str]:
    """Return the names of the homes in a folder, sorted; of a folder that is not there, none."""
    return sorted(entry.parent.name for entry in directory.glob(f"*/{MAP_NAME}"))


def files_of_home(name_or_path: str, homes_directory: Path) -> tuple[Path, Path | None]:
    """Return the map's file of a home, and the layer's if there is one; raises HomeError."""
    named = homes_directory / name_or_path / MAP_NAME
    path = Path(name_or_path).expanduser()
    is_name = bool(name_or_path) and Path(name_or_path).name == name_or_path
    if is_name and named.is_file():
        map_path = named
    elif name_or_path and path.is_dir():
        map_path = path / MAP_NAME
    elif name_or_path and path.is_file():
        map_path = path
    else:
        hint = suggestion(name_or_path, list_homes(homes_directory))
        raise HomeError(
            f"{homes_directory}: expected the name of a home there or the path of a map_server "
            f"yaml, got {name_or_path!r}; {hint}"
        )
    if not map_path.is_file():
        raise HomeError(f"{map_path.parent}: expected a home with a {MAP_NAME}, got none; add it")
    beside = map_path.with_name(f"{map_path.stem}.home.yaml")
    in_folder = map_path.with_name(LAYER_NAME)
    if beside.is_file():
        return map_path, beside
    if map_path.name == MAP_NAME and in_folder.is_file():
        return map_path, in_folder
    return map_path, None
