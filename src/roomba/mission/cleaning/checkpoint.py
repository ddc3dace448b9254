"""Plain values for checkpoints: masks and requests.

Paths and obstacles are not part of a checkpoint: the rest of a clean is planned anew from the floor
that is left.
"""

from __future__ import annotations

import base64
import binascii
import zlib
from typing import Any, Final

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRequest
from roomba.errors import RoombaError
from roomba.vocabulary import CarpetWay, CleanMode, EdgeOrder, FanLevel, RoomWay

VERSION: Final = 4
Values = dict[str, Any]


class CheckpointError(RoombaError):
    """A checkpoint that cannot be used; the message says why."""


def packed(mask: Mask) -> str:
    """Return a mask as text: packed bits, compressed, in base 64."""
    return base64.b64encode(zlib.compress(np.packbits(mask).tobytes(), 6)).decode("ascii")


def unpacked(text: str, shape: tuple[int, int]) -> Mask:
    """Return the mask of a text; raises CheckpointError if it is none of that shape."""
    cells = shape[0] * shape[1]
    try:
        # The limit is above what is expected, and keeps a text from unpacking to all of the memory.
        content = zlib.decompressobj().decompress(base64.b64decode(text, validate=True), cells)
    except (binascii.Error, zlib.error, ValueError) as error:
        raise CheckpointError(f"expected a packed mask: {error}") from error
    bits = np.frombuffer(content, np.uint8)
    if bits.size != (cells + 7) // 8:
        raise CheckpointError(f"expected a mask of {cells} cells, got {8 * bits.size}")
    return np.unpackbits(bits, count=cells).astype(np.bool_).reshape(shape)


def request_values(request: CleanRequest) -> Values:
    """Return a request as plain values."""
    return {
        "mode": request.mode.value,
        "rooms": list(request.rooms),
        "zones": [list(zone) for zone in request.zones],
        "spot": None if request.spot is None else list(request.spot),
        "passes": request.passes,
        "fan": request.fan.name,
        "in_order": request.in_order,
        "each": [[way.passes, way.fan.name] for way in request.each],
        "carpets": request.carpets.name,
        "edges": request.edges.name,
    }


def request_of(values: Values) -> CleanRequest:
    """Return the request of such values; raises KeyError, ValueError, TypeError or RoombaError."""
    spot = values["spot"]
    return CleanRequest(
        CleanMode(values["mode"]),
        rooms=tuple(str(name) for name in values["rooms"]),
        zones=tuple((float(a), float(b), float(c), float(d)) for a, b, c, d in values["zones"]),
        spot=None if spot is None else (float(spot[0]), float(spot[1])),
        passes=int(values["passes"]),
        fan=FanLevel[values["fan"]],
        in_order=bool(values["in_order"]),
        each=tuple(RoomWay(int(passes), FanLevel[fan]) for passes, fan in values["each"]),
        carpets=CarpetWay[values["carpets"]],
        edges=EdgeOrder[values["edges"]],
    )
