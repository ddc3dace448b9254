"""The map as a smart home shows it: of a robot in the middle of a clean."""

from __future__ import annotations

import io
import time
from collections import deque
from typing import Final

import numpy as np
from PIL import Image

from roomba.clean_request import CleanRequest
from roomba.client.floor_map import FloorMap
from roomba.client.view import LayerName
from roomba.commands.play.living import live_client
from roomba.errors import RoombaError
from roomba.geometry import Point
from roomba.plots.canvas import Picture
from roomba.ui.smart_home.map_picture import picture_of
from roomba.world.home.home import Home

_DEADLINE: Final = 60.0
"""s of wall time."""


def picture_of_smart_home(home: Home, covered: float = 14.0) -> Picture:
    """Let a robot clean so many m2, and draw its map."""
    robot = live_client(home.name, seed=1, speed=20.0, knows_map=True)
    robot.start()
    way: deque[Point] = deque()
    until = time.monotonic() + _DEADLINE
    try:
        robot.clean(CleanRequest())
        while (view := robot.robot()).vacuum.covered < covered:
            if time.monotonic() > until:
                raise RoombaError(f"expected {covered:g} m2 to be clean within {_DEADLINE:g} s")
            way.append(view.pose[:2])
            time.sleep(0.01)
        cells = robot.layer(LayerName.MAP)
        assert cells is not None
        coverage = robot.layer(LayerName.COVERAGE)
        floor = FloorMap(cells, coverage, robot.home(), view.pose, way)
    finally:
        robot.end()
    return np.asarray(Image.open(io.BytesIO(picture_of(floor))).convert("RGB"))
