"""Arrays of a file: right ones come back, and each wrong one is named in an error."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from roomba.geometry import Pose
from roomba.storage.array_fields import ArrayFields

FIELDS = ArrayFields(
    {
        "ranges": np.arange(6.0).reshape(2, 3),
        "holed": np.array([1.0, np.inf]),
        "place": np.array([1.0, 2.0, 0.5]),
        "nowhere": np.full(3, np.nan),
        "halfway": np.array([1.0, np.nan, 0.5]),
        "sizes": np.array([3, 0]),
        "owed": np.array([3, -1]),
        "seen": np.array([True, False]),
        "name": np.array("upstairs"),
    }
)


def test_what_is_right_comes_back() -> None:
    assert FIELDS.floats("ranges", -1, 3).tolist() == [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]
    assert FIELDS.pose("place") == Pose(1.0, 2.0, 0.5)
    assert FIELDS.pose("nowhere") is None
    assert FIELDS.counts("sizes", 2).tolist() == [3, 0]
    assert FIELDS.flags("seen", -1).tolist() == [True, False]
    assert FIELDS.text("name") == "upstairs"
    assert FIELDS.has("name")
    assert not FIELDS.has("names")


@pytest.mark.parametrize(
    ("read", "message"),
    [
        (lambda: FIELDS.floats("ranges", 6), r"ranges: expected float64 of shape \(6,\), got"),
        (lambda: FIELDS.floats("ranges", 3, -1), r"ranges: expected .* \(3, -1\), got .*\(2, 3\)"),
        (lambda: FIELDS.floats("sizes", 2), "sizes: expected float64 .* got int64"),
        (lambda: FIELDS.floats("holed", 2), "holed: expected finite numbers"),
        (lambda: FIELDS.pose("halfway"), "halfway: expected finite numbers"),
        (lambda: FIELDS.counts("owed", 2), "owed: expected 0 or more, got -1"),
        (lambda: FIELDS.counts("ranges", 2, 3), "ranges: expected int64"),
        (lambda: FIELDS.flags("sizes", 2), "sizes: expected bool"),
        (lambda: FIELDS.text("sizes"), "sizes: expected words, got int64"),
    ],
)
def test_what_is_not_is_named(read: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read()


def test_an_array_that_is_missing_is_a_key_error() -> None:
    with pytest.raises(KeyError, match="ways"):
        FIELDS.floats("ways", 3)
