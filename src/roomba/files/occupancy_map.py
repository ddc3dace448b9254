"""Reads and writes floor plans in map_server's format: a YAML file beside a picture.

The meaning of every field is that of map_server's ``image_loader.cpp``, with three differences
that keep unknown floor from being taken for free: a transparent pixel of any colour is unknown (in
map_server's trinary mode the alpha channel is averaged in as if it were a colour), raw values above
100 are unknown (map_server lets them wrap around), and map_saver's grey of 205 is unknown in a
picture that has hardly any greys but map_saver's and white. Nav2's map_saver writes a
``free_thresh`` of 0.25 by default, by which that grey would be free (navigation2, issue 5138).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Final, Literal

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator

from roomba.errors import HomeError
from roomba.files.image import Image, is_picture, read_image
from roomba.files.kept import write_kept
from roomba.files.strict_yaml import YamlFile, read_yaml
from roomba.grid import COARSEST_CELL, FINEST_CELL, FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap

Resolution = Annotated[float, Field(ge=FINEST_CELL, le=COARSEST_CELL, allow_inf_nan=False)]
Origin = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
"""m; farther off the cells of a map are no longer told apart."""
Threshold = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]

MAP_SAVER_PIXELS = {FREE: 254, OCCUPIED: 0, UNKNOWN: 205}
"""Grey values that map_saver writes, and that the usual thresholds read back."""
RAW_UNKNOWN = 255
_WRITE_ONE: Final = (
    "write one beside it with image, resolution (m for each pixel) and origin: [0.0, 0.0, 0.0]"
)
_NEARLY_ALL: Final = 0.95
_TURNED: Final = 1e-6
"""rad; less is what a program's rounding makes of 0: a map of 1 km is off by a millimetre."""
_SQUARE: Final = 5e-3
"""rad; a yaw as near as this to quarter turns, such as 1.57 or 4.71, means them."""


class MapDescription(BaseModel):
    """The YAML file; other keys are ignored."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    image: Annotated[str, Field(min_length=1)]
    resolution: Resolution
    origin: list[Origin]
    negate: Annotated[int, Field(ge=0, le=1)] = 0
    occupied_thresh: Threshold = 0.65
    free_thresh: Annotated[Threshold, Field(validate_default=True)] = 0.196
    mode: Literal["trinary", "scale", "raw"] = "trinary"

    @field_validator("origin")
    @classmethod
    def _is_a_pose(cls, origin: list[float]) -> list[float]:
        if len(origin) != 3:
            raise ValueError("expected three numbers, [x, y, yaw], the last 0.0 for none")
        return origin

    @field_validator("mode", mode="before")
    @classmethod
    def _in_small_letters(cls, mode: object) -> object:
        return mode.lower() if isinstance(mode, str) else mode

    @field_validator("free_thresh")
    @classmethod
    def _is_not_above_occupied(cls, free: float, info: ValidationInfo) -> float:
        occupied = info.data.get("occupied_thresh", 1.0)
        if free > occupied:
            raise ValueError(f"expected no more than occupied_thresh, {occupied}")
        return free


def load_map(path: Path) -> OccupancyMap:
    """Return the map that a map_server YAML file describes.

    Row 0 of the values is the lowest y. Raises :class:`HomeError`, which names the file, the line
    and the reason, for a file that is missing, broken, or turned off the axes by an origin's yaw.
    """
    file = _yaml_of(path)
    description = file.validated(MapDescription)
    quarters = _quarters(description.origin[2])
    if quarters is None:
        raise file.error(
            ("origin", 2),
            f"origin: expected a yaw of 0, or of quarter turns, got {description.origin[2]}; "
            "turn the picture instead, maps of this robot lie along the axes",
        )
    image = _image_of(file, description)
    return _turned(_occupancy(image, description)[::-1], description, quarters)


def _yaml_of(path: Path) -> YamlFile:
    try:
        return read_yaml(path)
    except HomeError as error:
        if not is_picture(path):
            raise
        beside = path.with_suffix(".yaml")
        raise HomeError(
            f"{path}: expected the YAML file of a map, got a picture; "
            + (f"name {beside}" if beside.is_file() else _WRITE_ONE)
        ) from error


def _quarters(yaw: float) -> int | None:
    """Return by how many quarters a yaw, rad, turns counter-clockwise, 0..3; None for others."""
    quarters = round(yaw / (math.pi / 2.0))
    within = _SQUARE if quarters else _TURNED
    return quarters % 4 if abs(yaw - quarters * math.pi / 2.0) <= within else None


def _turned(values: NDArray[np.int8], description: MapDescription, quarters: int) -> OccupancyMap:
    """Return a map turned by quarters about the lower left corner of its picture."""
    resolution, (x, y, _) = description.resolution, description.origin
    height, width = (cells * resolution for cells in values.shape)
    left = (0.0, height, width, 0.0)[quarters]
    below = (0.0, 0.0, height, width)[quarters]
    turned = np.ascontiguousarray(np.rot90(values, -quarters))
    return OccupancyMap(GridFrame(resolution, x - left, y - below, *turned.shape), turned)


def save_map(occupancy: OccupancyMap, path: Path) -> None:
    """Write a map as ``path`` (YAML) and a PGM beside it; :func:`load_map` returns it identically.

    Both are sealed in comments. Maps of free, occupied and unknown are written as map_saver does,
    others in raw mode. Raises ValueError for values outside -1..100 and OSError when the disk
    refuses.
    """
    values = occupancy.values
    if values.min() < UNKNOWN or values.max() > OCCUPIED:
        raise ValueError(
            f"expected map values from -1 to 100, got {values.min()} to {values.max()}"
        )
    trinary = bool(np.isin(values, list(MAP_SAVER_PIXELS)).all())
    pixels = _map_saver_pixels(values) if trinary else _raw_pixels(values)
    image = path.with_suffix(".pgm")
    rows, columns = pixels.shape
    write_kept(image, f"P5\n{columns} {rows}\n255\n".encode() + pixels[::-1].tobytes())
    frame = occupancy.frame
    lines = [
        yaml.safe_dump({"image": image.name}, allow_unicode=True, width=math.inf).rstrip(),
        f"resolution: {frame.resolution!r}",
        f"origin: [{frame.origin_x!r}, {frame.origin_y!r}, 0.0]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
        f"mode: {'trinary' if trinary else 'raw'}",
    ]
    write_kept(path, ("\n".join(lines) + "\n").encode())


def _image_of(file: YamlFile, description: MapDescription) -> Image:
    path = file.path.parent / description.image
    try:
        return read_image(path)
    except HomeError as error:
        raise file.error(("image",), f"image: {error}") from error


def _occupancy(image: Image, description: MapDescription) -> NDArray[np.int8]:
    """Apply mode, negate and thresholds to the grey values 0..255, row 0 at the top."""
    grey = 255.0 - image.grey if description.negate else image.grey
    if description.mode == "raw":
        return np.where(grey <= OCCUPIED, grey, UNKNOWN).astype(np.int8)
    occupied_share = (255.0 - grey) / 255.0
    occupied = occupied_share > description.occupied_thresh
    free = (occupied_share < description.free_thresh) & ~occupied
    values = np.full(grey.shape, UNKNOWN, np.int8)
    if description.mode == "scale":
        values[:] = _scaled(occupied_share, description)
    values[occupied] = OCCUPIED
    values[free] = FREE
    if description.mode == "trinary" and _is_of_map_saver(grey):
        values[grey == MAP_SAVER_PIXELS[UNKNOWN]] = UNKNOWN
    values[image.transparent] = UNKNOWN
    return values


def _is_of_map_saver(grey: NDArray[np.float64]) -> bool:
    """Whether nearly all of a picture has greys that map_saver writes; a person may edit some.

    Picture editors turn its grey of 254 into white.
    """
    return bool(np.isin(grey, [*MAP_SAVER_PIXELS.values(), 255]).mean() >= _NEARLY_ALL)


def _scaled(share: NDArray[np.float64], description: MapDescription) -> NDArray[np.int8]:
    """Spread what lies between the thresholds over 1..99."""
    span = description.occupied_thresh - description.free_thresh
    if span <= 0.0:
        return np.full(share.shape, 99, np.int8)
    ratio = np.clip((share - description.free_thresh) / span, 0.0, 1.0)
    return (1.0 + 98.0 * ratio).astype(np.int8)


def _map_saver_pixels(values: NDArray[np.int8]) -> NDArray[np.uint8]:
    pixels = np.empty(values.shape, np.uint8)
    for value, pixel in MAP_SAVER_PIXELS.items():
        pixels[values == value] = pixel
    return pixels


def _raw_pixels(values: NDArray[np.int8]) -> NDArray[np.uint8]:
    return np.where(values == UNKNOWN, RAW_UNKNOWN, values).astype(np.uint8)
