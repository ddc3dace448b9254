"""Messages as plain values and back: only values that JSON cannot express are lost."""

from __future__ import annotations

import io
import json
import math
import sys
from pathlib import Path
from typing import Any

import genpy
import pytest
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import PoseStamped, Twist
from hypothesis import given
from hypothesis import strategies as st
from nav_msgs.msg import OccupancyGrid
from roomba_robot.msg import CleanActionGoal
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import ColorRGBA, Float32, Header, Int8, String, UInt64

from roomba_ros.convert.errors import MessageError
from roomba_ros.plain.messages import MOST_ELEMENTS, class_of, message_from, plain_of

NOW = genpy.Time(12, 34)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)


@given(
    name=st.lists(st.text(max_size=5), max_size=3),
    position=st.lists(NUMBERS, max_size=3),
    stamp=st.tuples(st.integers(0, 2**32 - 1), st.integers(0, 999_999_999)),
)
def test_a_message_comes_back_whole(
    name: list[str], position: list[float], stamp: tuple[int, int]
) -> None:
    message = JointState(Header(1, genpy.Time(*stamp), "map"), name, position, [], [])
    told = json.loads(json.dumps(plain_of(message)))
    assert message_from(JointState, told, NOW) == message


def test_numbers_that_are_none_are_null_and_come_back_as_none() -> None:
    told = plain_of(JointState(position=[1.0, math.nan, math.inf]))
    assert told["position"] == [1.0, None, None]
    assert plain_of(Float32(math.nan)) == {"data": None}
    assert math.isnan(message_from(Float32, {"data": None}, NOW).data)
    assert math.isnan(message_from(Float32, json.loads('{"data": NaN}'), NOW).data)


def test_bytes_are_base64() -> None:
    assert plain_of(Image(data=b"\x00\x01\xff"))["data"] == "AAH/"
    assert message_from(Image, {"data": "AAH/"}, NOW).data == b"\x00\x01\xff"
    assert message_from(Image, {"data": [0, 1, 255]}, NOW).data == b"\x00\x01\xff"
    # No bytes, although they are as short: numbers with a sign.
    assert plain_of(OccupancyGrid(data=[-1, 100]))["data"] == [-1, 100]


def test_a_header_without_a_stamp_gets_one() -> None:
    assert message_from(PoseStamped, {}, NOW).header.stamp == NOW
    assert message_from(PoseStamped, {"header": {"frame_id": "map"}}, NOW).header.stamp == NOW
    given = {"header": {"stamp": {"secs": 1}}}
    assert message_from(PoseStamped, given, NOW).header.stamp == genpy.Time(1, 0)
    assert message_from(GoalID, {"stamp": "now"}, NOW).stamp == NOW


def test_what_is_left_out_is_as_by_default() -> None:
    goal = message_from(CleanActionGoal, {"goal": {"passes": 2}}, NOW)
    assert goal.goal.passes == 2
    assert goal.goal.rooms == CleanActionGoal().goal.rooms
    assert message_from(Twist, {"linear": {"x": 1}}, NOW).linear.x == 1.0


@pytest.mark.parametrize(
    ("kind", "plain", "reason"),
    [
        (Twist, {"linaer": {}}, "geometry_msgs/Twist has no field 'linaer'; it has linear, angul"),
        (Twist, {"linear": 3}, r"linear: expected an object \(geometry_msgs/Vector3\), got 3"),
        (Twist, {"linear": {"x": "1"}}, "linear.x: expected a number, got '1'"),
        (Twist, {"linear": {"x": True}}, "linear.x: expected a number"),
        (Twist, [1], "the message: expected an object"),
        (Int8, {"data": 128}, "data: expected a whole number from -128 to 127, got 128"),
        (Int8, {"data": 1.5}, "expected a whole number"),
        (UInt64, {"data": -1}, "from 0 to 18446744073709551615"),
        (Float32, {"data": 1e300}, "expected a number of 32 bits"),
        (ColorRGBA, {"r": 10**400}, "expected a number"),
        (String, {"data": None}, "expected a text"),
        (String, {"data": "\ud800"}, "expected a text of whole characters"),
        (Image, {"data": "***"}, "base64"),
        (Image, {"data": [256]}, r"data\[0\]: expected a whole number from 0 to 255"),
        (JointState, {"name": "joint"}, "name: expected an array"),
        (JointState, {"name": [1]}, r"name\[0\]: expected a text, got 1"),
        (CameraInfo, {"K": [0.0] * 8}, "K: expected 9 values, got 8"),
        (GoalID, {"stamp": 3}, "stamp: expected a time"),
        (GoalID, {"stamp": {"secs": -1}}, "stamp.secs: expected a whole number"),
    ],
)
def test_what_does_not_fit_is_refused_with_place_and_reason(
    kind: type, plain: Any, reason: str
) -> None:
    with pytest.raises(MessageError, match=reason):
        message_from(kind, plain, NOW)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["header", "pose", "position", "x", "stamp"]), inner)
    ),
)


@given(VALUES)
def test_anything_is_a_message_that_can_be_sent_or_refused(plain: Any) -> None:
    try:
        message = message_from(PoseStamped, plain, NOW)
    except MessageError:
        return
    message.serialize(io.BytesIO())


def test_huge_arrays_do_not_become_json() -> None:
    with pytest.raises(MessageError, match="read this topic by ROS itself"):
        plain_of(OccupancyGrid(data=[0] * (MOST_ELEMENTS + 1)))


@pytest.mark.parametrize(
    "kind", ["", "String", "std_msgs/Nothing", "../x/y", "a/b/c", "os/path", "std_msgs/../x", "é/é"]
)
def test_types_that_there_are_not(kind: str) -> None:
    with pytest.raises(MessageError, match="expected a type of msg"):
        class_of(kind)


def test_no_package_is_imported_because_a_program_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "named_by_a_program" / "msg").mkdir(parents=True)
    (tmp_path / "named_by_a_program" / "__init__.py").write_text("raise SystemExit")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(MessageError):
        class_of("named_by_a_program/Thing")
    assert "named_by_a_program" not in sys.modules
