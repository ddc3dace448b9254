"""Masks and requests as plain values, and back; junk is refused by name."""

from __future__ import annotations

import base64
import json
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from roomba.arrays import Mask
from roomba.clean_request import CleanRequest
from roomba.errors import RoombaError
from roomba.mission.cleaning.checkpoint import (
    CheckpointError,
    Values,
    packed,
    request_of,
    request_values,
    unpacked,
)
from roomba.vocabulary import MOST_PASSES, CleanMode, FanLevel, RoomWay, fault_of_name

sizes = st.tuples(st.integers(1, 40), st.integers(1, 40))
numbers = st.floats(-50.0, 50.0)


@given(arrays.arrays(np.bool_, sizes))
def test_a_mask_comes_back_as_it_was(mask: Mask) -> None:
    text = packed(mask)
    assert isinstance(json.loads(json.dumps(text)), str)
    back = unpacked(text, (len(mask), len(mask[0])))
    assert back.dtype == np.bool_
    assert (back == mask).all()


def test_a_large_mask_is_small() -> None:
    mask = np.zeros((1000, 1200), np.bool_)
    mask[300:700, 200:900] = True
    assert len(packed(mask)) < 5000


@pytest.mark.parametrize(
    "text",
    [
        "",
        "!!!",
        "AAAA",
        "ü",
        base64.b64encode(b"junk").decode(),
        packed(np.ones((10, 9), np.bool_)),
        packed(np.ones((10, 11), np.bool_)),
        base64.b64encode(zlib.compress(b"")).decode(),
    ],
)
def test_what_is_no_such_mask_is_refused(text: str) -> None:
    with pytest.raises(CheckpointError, match="expected a") as refused:
        unpacked(text, (10, 10))
    assert isinstance(refused.value, RoombaError)


@given(st.binary(max_size=60))
def test_no_junk_gets_through(junk: bytes) -> None:
    with pytest.raises(CheckpointError):
        unpacked(base64.b64encode(zlib.compress(junk) + b"x"[: len(junk) % 2]).decode(), (50, 50))


NAMES = st.text(min_size=1).filter(lambda name: not fault_of_name(name))


@st.composite
def requests(draw: st.DrawFn) -> CleanRequest:
    zones = [
        (x, y, x + width, y + height)
        for x, y, width, height in draw(
            st.lists(
                st.tuples(numbers, numbers, st.floats(0.1, 9.0), st.floats(0.1, 9.0)),
                min_size=1,
                max_size=3,
            )
        )
    ]
    mode, rooms = draw(st.sampled_from(CleanMode)), draw(st.lists(NAMES, min_size=1, max_size=3))
    ways = st.builds(RoomWay, st.integers(1, MOST_PASSES), st.sampled_from(FanLevel))
    each = draw(st.lists(ways, min_size=len(rooms), max_size=len(rooms)))
    return CleanRequest(
        mode,
        tuple(rooms),
        tuple(zones),
        draw(st.none() | st.tuples(numbers, numbers)),
        draw(st.integers(1, MOST_PASSES)),
        draw(st.sampled_from(FanLevel)),
        draw(st.booleans()),
        tuple(each) if mode is CleanMode.ROOMS and draw(st.booleans()) else (),
    )


@given(requests())
def test_a_request_comes_back_as_it_was(request: CleanRequest) -> None:
    assert request_of(json.loads(json.dumps(request_values(request)))) == request


@pytest.mark.parametrize(
    ("name", "junk"),
    [
        ("mode", "thorough"),
        ("rooms", 5),
        ("zones", [[1.0, 2.0, 3.0]]),
        ("zones", [[1.0, 2.0, 0.0, 3.0]]),
        ("passes", 99),
        ("passes", None),
        ("fan", "LOUD"),
        ("spot", [None, 1.0]),
    ],
)
def test_a_request_of_junk_is_refused(name: str, junk: object) -> None:
    values: Values = {**request_values(CleanRequest()), name: junk}
    with pytest.raises((KeyError, ValueError, TypeError, RoombaError)):
        request_of(values)


@pytest.mark.parametrize("name", list(request_values(CleanRequest())))
def test_a_request_without_something_is_refused(name: str) -> None:
    values = request_values(CleanRequest())
    del values[name]
    with pytest.raises(KeyError, match=name):
        request_of(values)
