"""Maps of Valetudo are read: what they must have, and where it lies in the robot's frame."""

from __future__ import annotations

import math
from typing import Annotated, Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from roomba.arrays import Mask
from roomba.files.plain_json import load_json
from roomba.files.valetudo.home import CM, VERSION, ValetudoError, ValetudoHome
from roomba.geometry import Point, Pose
from roomba.grid import FREE, MOST_CELLS, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.raster.seams import without_seams
from roomba.vocabulary import another_name, cleaned_name

_KINDS: Final = ("floor", "segment", "wall")
"""Layers that are read, walls last: some robots tell floor below them."""
_MARGIN: Final = 2
"""Cells around what a map shows."""
_MOST_LAYERS: Final = 100
"""Rooms, floor and walls; each takes a cell's byte of memory for all cells."""
_FARTHEST: Final = 1_000_000
"""cm, and pixels; no home has a place farther from its corner."""
_OFF: Final = 500
"""cm; the farthest that a place may be off the map."""


class _Part(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True, strict=True)


_Pixel = Annotated[int, Field(ge=-_FARTHEST, le=_FARTHEST)]
_Place = Annotated[float, Field(ge=-_FARTHEST, le=_FARTHEST)]


class _Size(_Part):
    x: Annotated[int, Field(gt=0, le=_FARTHEST)]
    y: Annotated[int, Field(gt=0, le=_FARTHEST)]


def _empty_for_none(told: object) -> object:
    return {} if told is None else told


class _LayerMeta(_Part):
    segmentId: str | int | None = None  # noqa: N815
    name: str | None = None


class _Layer(_Part):
    type: str
    pixels: list[_Pixel] = []
    compressedPixels: list[_Pixel] = []  # noqa: N815
    metaData: Annotated[_LayerMeta, BeforeValidator(_empty_for_none)] = _LayerMeta()  # noqa: N815


class _EntityMeta(_Part):
    angle: float | None = None


class _Entity(_Part):
    type: str
    points: list[_Place] = []
    metaData: Annotated[_EntityMeta, BeforeValidator(_empty_for_none)] = _EntityMeta()  # noqa: N815


class _Meta(_Part):
    version: int
    origin: Annotated[list[_Place], Field(min_length=2, max_length=2)] | None = None


class _Map(_Part):
    size: _Size
    pixelSize: Annotated[int, Field(gt=0, le=100)]  # noqa: N815
    layers: Annotated[list[_Layer], Field(max_length=_MOST_LAYERS)]
    entities: list[_Entity] = []
    metaData: _Meta  # noqa: N815


def parse(text: str) -> ValetudoHome:
    """Return the home of a map; raises ValetudoError with what was expected, and came."""
    found = _validated(text)
    columns, rows = found.size.x // found.pixelSize, found.size.y // found.pixelSize
    if not 0 < rows * columns <= MOST_CELLS:
        raise ValetudoError(
            f"size: expected 1 to {MOST_CELLS} pixels of {found.pixelSize} cm, got "
            f"{found.size.x} x {found.size.y} cm"
        )
    layers = [
        (layer, _mask(layer, number, rows, columns))
        for number, layer in enumerate(found.layers)
        if layer.type in _KINDS
    ]
    values = np.full((rows, columns), UNKNOWN, np.int8)
    for kind in _KINDS:
        for layer, mask in layers:
            if layer.type == kind:
                values[mask] = OCCUPIED if kind == "wall" else FREE
    if not (values == FREE).any():
        raise ValetudoError("layers: expected floor or segments, got none; map the home first")
    rooms = [(name, mask & (values == FREE)) for name, mask in _named(layers)]
    if found.metaData.origin is None:
        values, rooms = _without_seams(values, rooms, found.pixelSize * CM)
    return _placed(found, values, rooms)


def _validated(text: str) -> _Map:
    if not text.strip():
        raise ValetudoError("expected a map of Valetudo in JSON, the file is empty")
    try:
        raw = load_json(text)
    except ValueError as error:
        raise ValetudoError(f"expected a map of Valetudo in JSON: {error}") from error
    if not isinstance(raw, dict) or "layers" not in raw or "pixelSize" not in raw:
        got = ", ".join(list(raw)[:6]) if isinstance(raw, dict) else type(raw).__name__
        got = got or "nothing"
        raise ValetudoError(
            "expected a map of Valetudo with size, pixelSize, layers, entities and metaData, got "
            f"{got}; it is what Valetudo gives at api/v2/robot/state/map"
        )
    try:
        found = _Map.model_validate(raw)
    except ValidationError as error:
        raise ValetudoError(_reason(dict(error.errors()[0]))) from error
    if found.metaData.version not in (1, VERSION):
        raise ValetudoError(
            f"metaData.version: expected 1 or {VERSION}, got {found.metaData.version}"
        )
    return found


def _reason(error: dict[str, Any]) -> str:
    """Return what was expected and what came, of pydantic's error."""
    where = ".".join(str(part) for part in error["loc"])
    if error["type"] == "missing":
        return f"{where}: expected a value, got nothing"
    expected = str(error["msg"]).replace("Input should be", "expected")
    return f"{where}: {expected}, got {str(error['input'])[:60]!r}"


def _mask(layer: _Layer, number: int, rows: int, columns: int) -> Mask:
    """Return the pixels of a layer, row 0 below."""
    try:
        x, y, count = _runs(layer)
        if (count < 1).any() or min(x.min(initial=0), y.min(initial=0)) < 0:
            raise ValueError("counts from 1 on, and no pixel left of or above the map")
        if (x + count).max(initial=0) > columns or y.max(initial=-1) >= rows:
            raise ValueError(f"pixels within {columns} x {rows}")
    except ValueError as error:
        raise ValetudoError(f"layers.{number}: expected {error}") from error
    mask = np.zeros((rows, columns), np.bool_)
    for first, row, length in zip(x.tolist(), y.tolist(), count.tolist(), strict=True):
        mask[rows - 1 - row, first : first + length] = True
    return mask


def _runs(layer: _Layer) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return x, y and count of runs."""
    if layer.compressedPixels:
        if len(layer.compressedPixels) % 3:
            raise ValueError("compressedPixels of three numbers each: x, y, count")
        x, y, count = np.array(layer.compressedPixels, np.int64).reshape(-1, 3).T
        return x, y, count
    if len(layer.pixels) % 2:
        raise ValueError("pixels of two numbers each: x, y")
    x, y = np.array(layer.pixels, np.int64).reshape(-1, 2).T
    return x, y, np.ones_like(x)


def _named(layers: list[tuple[_Layer, Mask]]) -> list[tuple[str, Mask]]:
    """Return rooms with valid names that all differ; rooms without a name are numbered."""
    rooms: list[tuple[str, Mask]] = []
    for number, (layer, mask) in enumerate(
        ((layer, mask) for layer, mask in layers if layer.type == "segment"), start=1
    ):
        meta = layer.metaData
        segment = number if meta.segmentId is None else meta.segmentId
        name = cleaned_name(meta.name or "") or cleaned_name(f"Room {segment}")
        taken = [other for other, _ in rooms]
        rooms.append((another_name(name, taken) if name in taken else name, mask))
    return rooms


def _without_seams(
    values: NDArray[np.int8], rooms: list[tuple[str, Mask]], resolution: float
) -> tuple[NDArray[np.int8], list[tuple[str, Mask]]]:
    """Return cells and rooms without seams: each cell of one is floor of the room beside it."""
    owners = np.zeros(values.shape, np.int16)
    for number, (_, mask) in enumerate(rooms, start=1):
        owners[mask] = number
    owners = without_seams(owners, values == UNKNOWN, values == OCCUPIED, resolution)
    joined = np.where(owners > 0, np.int8(FREE), values)
    is_new = values != joined
    return joined, [
        (name, mask | (is_new & (owners == number)))
        for number, (name, mask) in enumerate(rooms, start=1)
    ]


def _placed(found: _Map, values: NDArray[np.int8], rooms: list[tuple[str, Mask]]) -> ValetudoHome:
    """Return all in the map's frame."""
    cell = found.pixelSize * CM
    rows, columns = values.shape
    cut = (slice(0, rows), slice(0, columns))
    charger = next((e for e in found.entities if e.type == "charger_location"), None)
    if charger is not None and not _is_on_map(charger, found.size):
        charger = None
    origin = found.metaData.origin
    if origin is None:
        cut = _around(values != UNKNOWN)
        x, y = (0.0, 0.0) if charger is None else _point(charger.points, rows, cell)
        origin = [cut[1].start * cell - x, cut[0].start * cell - y]
    frame = GridFrame(cell, origin[0], origin[1], *values[cut].shape)
    corner = origin[0] - cut[1].start * cell, origin[1] - cut[0].start * cell

    def points_of(entity: _Entity) -> tuple[Point, ...]:
        if len(entity.points) % 2:
            raise ValetudoError(
                f"entities: expected points of two numbers each, got {entity.points}"
            )
        pairs = zip(entity.points[::2], entity.points[1::2], strict=True)
        placed = (_point(list(pair), rows, cell) for pair in pairs)
        return tuple((x + corner[0], y + corner[1]) for x, y in placed)

    station = None
    if charger is not None:
        x, y = _point(charger.points, rows, cell)
        angle = charger.metaData.angle or 0.0
        station = Pose(x + corner[0], y + corner[1], _wrapped(math.radians(90.0 - angle)))
    return ValetudoHome(
        OccupancyMap(frame, np.ascontiguousarray(values[cut])),
        tuple((name, np.ascontiguousarray(mask[cut])) for name, mask in rooms),
        station,
        tuple(points_of(each) for each in found.entities if each.type == "no_go_area"),
        tuple(points_of(each) for each in found.entities if each.type == "virtual_wall"),
        found.metaData.origin is not None,
    )


def _is_on_map(entity: _Entity, size: _Size) -> bool:
    """Whether a place lies on the map, or near it, as on one that was cut.

    Some programs tell a place far away for what is not known.
    """
    x, y = _pair(entity.points)
    return -_OFF <= x <= size.x + _OFF and -_OFF <= y <= size.y + _OFF


def _around(mask: Mask) -> tuple[slice, slice]:
    """Return the rows and columns around a mask, with a margin."""
    bounds = []
    for axis, size in ((1, mask.shape[0]), (0, mask.shape[1])):
        cells = np.flatnonzero(mask.any(axis=axis))
        bounds.append(
            slice(max(int(cells[0]) - _MARGIN, 0), min(int(cells[-1]) + 1 + _MARGIN, size))
        )
    return bounds[0], bounds[1]


def _point(points: list[float], rows: int, cell: float) -> tuple[float, float]:
    """Return a point, m from the lower left corner."""
    x, y = _pair(points)
    return x * CM, rows * cell - y * CM


def _pair(points: list[float]) -> tuple[float, float]:
    """Return a point's two numbers; raises ValetudoError where there are not two."""
    if len(points) != 2:
        raise ValetudoError(f"entities: expected points of two numbers each, got {points}")
    return points[0], points[1]


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)
