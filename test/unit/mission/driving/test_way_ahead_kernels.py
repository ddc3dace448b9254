"""How far a path is clear, against a slow walk along it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.mission.driving.way_ahead_kernels import AHEAD, is_blocked
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer

FIELD = SurfaceField.of(room_home().map)
KEEP, LOOK_AHEAD, HORIZON = 0.16, 0.4, 2.0
POINTS = np.array([(0.5, 0.5), (3.0, 0.5), (3.0, 2.5)])
STATIONS = np.array([0.0, 2.5, 4.5])


def row_of(leaves_until: float = 0.0) -> NDArray[np.void]:
    """Before the first look."""
    rows = np.zeros(1, AHEAD)
    rows[0] = -1, 0.0, math.nan, LOOK_AHEAD, leaves_until, KEEP
    return rows


def layer_with(x: float, y: float) -> ThingLayer:
    """A layer in which a thing stands at a place, m."""
    layer = ThingLayer(FIELD)
    things = layer.arrays
    things.listed[0] = 7
    things.evidence[7] = layer.config.enough
    things.spots[7] = x, y
    things.layer["count"] = 1
    return layer


def first_near(x: float, y: float, first: float, reach: float) -> float:
    """Where a walk along the path in steps of a millimetre is nearer to a place first; else inf."""
    for station in np.arange(first, first + HORIZON, 0.001).tolist():
        if station > STATIONS[-1]:
            break
        at_x = np.interp(station, STATIONS, POINTS[:, 0])
        at_y = np.interp(station, STATIONS, POINTS[:, 1])
        if math.hypot(at_x - x, at_y - y) < reach:
            return float(station)
    return math.inf


@given(
    x=st.floats(0.2, 3.5),
    y=st.floats(0.2, 3.0),
    along=st.floats(0.0, 4.0),
    leaves_until=st.floats(0.0, 1.0),
)
def test_it_is_clear_until_before_the_first_thing(
    x: float, y: float, along: float, leaves_until: float
) -> None:
    layer, rows = layer_with(x, y), row_of(leaves_until)
    told = is_blocked(rows, layer.arrays, POINTS, STATIONS, 0, along)
    # A look ends HORIZON before the robot, also where it begins later, at ``leaves_until``.
    at = first_near(x, y, max(along, leaves_until), KEEP + layer.config.spot_radius)
    if at >= along + HORIZON - 0.002 or at <= 0.002:
        return
    assert rows[0]["clear_to"] == pytest.approx(at - LOOK_AHEAD, abs=0.0021)
    if abs(at - LOOK_AHEAD - along) > 0.0021:
        assert told == (at - LOOK_AHEAD <= along)


def test_it_looks_again_for_another_version_and_when_it_has_come_so_far() -> None:
    layer, rows = layer_with(2.0, 0.5), row_of()
    nothing = ThingLayer(FIELD).arrays
    assert not is_blocked(rows, nothing, POINTS, STATIONS, 3, 0.0)
    assert rows[0]["checked"] == 3
    assert rows[0]["clear_to"] == pytest.approx(HORIZON - LOOK_AHEAD)
    # What came meanwhile is not known before there is another version.
    assert not is_blocked(rows, layer.arrays, POINTS, STATIONS, 3, 1.0)
    assert is_blocked(rows, layer.arrays, POINTS, STATIONS, 4, 1.0)
    assert is_blocked(rows, layer.arrays, POINTS, STATIONS, 4, 1.2)
    assert not is_blocked(rows, nothing, POINTS, STATIONS, 4, 1.2)
