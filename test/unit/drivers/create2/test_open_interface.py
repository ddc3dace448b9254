"""The numbers of the Open Interface, as far as they depend on each other."""

from __future__ import annotations

import pytest

from roomba.drivers.create2.open_interface import FORMATS, GROUPS, checked, format_of, packets_of


def test_each_packet_from_7_to_58_has_its_size() -> None:
    assert list(FORMATS) == list(range(7, 59))
    wide = {packet for packet in FORMATS if format_of(packet).size == 2}
    assert wide == {
        19,
        20,
        22,
        23,
        *range(25, 32),
        33,
        *range(39, 45),
        *range(46, 52),
        *range(54, 58),
    }


def test_a_group_is_all_of_its_packets() -> None:
    for group in GROUPS:
        assert format_of(group).size == sum(format_of(packet).size for packet in packets_of(group))
    with pytest.raises(KeyError):
        format_of(59)


def test_all_bytes_of_a_frame_add_up_to_nothing() -> None:
    # The example of the specification of the stream.
    assert checked(bytes([19, 5, 29, 2, 25, 13, 0])) == bytes([19, 5, 29, 2, 25, 13, 0, 163])
