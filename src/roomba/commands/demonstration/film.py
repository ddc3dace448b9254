"""A film of the maps that a smart home was shown; the map stays in place from frame to frame."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from PIL import Image

from roomba.commands.demonstration.listener import HeardMessage
from roomba.files.valetudo.reading import parse
from roomba.grid import UNKNOWN
from roomba.plots.canvas import Picture

_KEYWORD: Final = "ValetudoMap"
_AROUND: Final = 0.2
"""m around what is known, which such a picture shows."""
_PAPER: Final = (226, 222, 213)


@dataclass(frozen=True, slots=True)
class PlacedMap:
    """A picture of a map, and where in it the map's frame begins, px from the left and the top."""

    picture: Image.Image
    corner: tuple[int, int]


def frames_of(messages: Sequence[HeardMessage], each: float) -> list[Picture]:
    """Return a frame for each so many s of the messages of a map, and the last one."""
    chosen: list[HeardMessage] = []
    for message in messages:
        if not chosen or message.time - chosen[-1].time >= each:
            chosen.append(message)
    if messages and chosen[-1] is not messages[-1]:
        chosen.append(messages[-1])
    return laid_alike([placed(message.payload) for message in chosen])


def placed(png: bytes) -> PlacedMap:
    """Find the origin of the map's frame by the map of Valetudo that is packed into a picture."""
    image = Image.open(io.BytesIO(png))
    image.load()
    occupancy = parse(image.info[_KEYWORD]).occupancy
    known, frame = occupancy.values != UNKNOWN, occupancy.frame
    around = round(_AROUND / frame.resolution)
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    first, last = max(columns[0] - around, 0), min(columns[-1] + 1 + around, frame.columns)
    top = min(rows[-1] + 1 + around, frame.rows)
    scale = image.width / (last - first)
    across = -(frame.origin_x / frame.resolution + first) * scale
    down = (frame.origin_y / frame.resolution + top) * scale
    return PlacedMap(image.convert("RGB"), (round(across), round(down)))


def laid_alike(maps: Sequence[PlacedMap]) -> list[Picture]:
    """Return pictures of one size in which the map's frame lies at the same place."""
    left = max(each.corner[0] for each in maps)
    above = max(each.corner[1] for each in maps)
    right = max(each.picture.width - each.corner[0] for each in maps)
    below = max(each.picture.height - each.corner[1] for each in maps)
    frames = []
    for each in maps:
        paper = Image.new("RGB", (left + right, above + below), _PAPER)
        paper.paste(each.picture, (left - each.corner[0], above - each.corner[1]))
        frames.append(np.asarray(paper))
    return frames
