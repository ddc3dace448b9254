"""The header of a connection: any bytes are a header, or are refused by a known error.

An unknown error would end the thread of the handshake, and leave the connection open.
"""

from __future__ import annotations

import struct
from typing import Any

import pytest
from fixtures.said import Said
from fixtures.spoiled import spoiled
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from rosgraph.network import ROSHandshakeException, encode_ros_handshake_header

from roomba_ros.runtime.connections import LONGEST_HEADER, NothingSaidError, header_of

WHOLE = {"callerid": "/a", "topic": "/odom", "md5sum": "*", "type": "nav_msgs/Odometry"}
KNOWN = (OSError, ValueError, ROSHandshakeException)


def header(content: bytes) -> dict[str, str]:
    connection: Any = Said(content)
    return header_of(connection)


def test_a_whole_header_is_read() -> None:
    assert header(encode_ros_handshake_header(WHOLE)) == WHOLE


def test_one_that_is_closed_without_a_word_is_told_from_one_that_breaks_off() -> None:
    with pytest.raises(NothingSaidError):
        header(b"")
    for broken_off in (b"\x04", struct.pack("<I", 4), struct.pack("<I", 4) + b"abc"):
        with pytest.raises(ConnectionError, match="before it said") as refused:
            header(broken_off)
        assert not isinstance(refused.value, NothingSaidError)


@pytest.mark.parametrize("left", [1, 2, 3])
def test_one_that_ends_within_the_length_of_a_field_is_refused(left: int) -> None:
    field = struct.pack("<I", 3) + b"a=b"
    content = field + bytes(left)
    with pytest.raises(ROSHandshakeException, match="expected whole fields"):
        header(struct.pack("<I", len(content)) + content)


def test_one_that_is_too_long_is_refused_before_it_is_read() -> None:
    with pytest.raises(ROSHandshakeException, match="at most"):
        header(struct.pack("<I", LONGEST_HEADER + 1))


@settings(max_examples=examples(500), derandomize=True, deadline=None)
@given(
    st.one_of(
        spoiled(encode_ros_handshake_header(WHOLE)),
        st.binary(max_size=60).map(lambda said: struct.pack("<I", len(said)) + said),
    )
)
def test_any_bytes_are_a_header_or_refused(content: bytes) -> None:
    try:
        found = header(content)
    except KNOWN:
        return
    assert all(isinstance(part, str) for pair in found.items() for part in pair)
