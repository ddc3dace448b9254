"""Frames of a stream, found among lost and garbled bytes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.drivers.create2.frames import FrameReader
from roomba.drivers.create2.open_interface import HEADER, checked
from roomba.drivers.create2.telling import ALL, FAST, SLOW

LAYOUT = (7, 43, 44)


def frame(bumps: int, left: int, right: int) -> bytes:
    body = bytes([7, bumps, 43, *left.to_bytes(2, "big"), 44, *right.to_bytes(2, "big")])
    return checked(bytes([HEADER, len(body)]) + body)


def test_a_frame_that_comes_in_pieces_is_read() -> None:
    reader = FrameReader([LAYOUT])
    sent = frame(3, 19, 0x1308) * 3
    told = [packets for byte in sent for packets in reader.take(bytes([byte]))]
    assert told == [{7: 3, 43: 19, 44: 0x1308}] * 3
    assert reader.spoilt == 0


@pytest.mark.parametrize("place", range(len(frame(1, 500, 600))))
def test_a_byte_that_is_lost_costs_one_frame(place: int) -> None:
    reader, sent = FrameReader([LAYOUT]), frame(1, 500, 600)
    told = reader.take(sent[:place] + sent[place + 1 :] + sent + sent)
    assert told[-1] == {7: 1, 43: 500, 44: 600}
    assert len(told) == 2


@pytest.mark.parametrize("place", range(len(frame(1, 500, 600))))
def test_a_byte_that_is_garbled_spoils_its_frame_alone(place: int) -> None:
    reader, sent = FrameReader([LAYOUT]), frame(1, 500, 600)
    spoilt = sent[:place] + bytes([sent[place] ^ 0x40]) + sent[place + 1 :]
    assert reader.take(spoilt + sent + sent) == [{7: 1, 43: 500, 44: 600}] * 2


def test_of_ten_thousand_random_bytes_none_makes_a_frame() -> None:
    reader, random = FrameReader([ALL, FAST, SLOW]), np.random.default_rng(3)
    assert reader.take(random.bytes(10_000)) == []
    assert reader.spoilt > 0


def test_a_frame_of_other_packets_is_none() -> None:
    body = bytes([8, 3, 43, 0, 19, 44, 0, 20])
    assert FrameReader([LAYOUT]).take(checked(bytes([HEADER, len(body)]) + body)) == []


@given(st.binary(max_size=60), st.integers(0, 10))
def test_after_anything_whole_frames_are_read_again(noise: bytes, cut: int) -> None:
    reader = FrameReader([LAYOUT])
    told = reader.take(noise + frame(0, 1, 2)[cut:] + frame(0, 7, 8) * 12)
    assert told[-1] == {7: 0, 43: 7, 44: 8}
    assert len(told) >= 10
