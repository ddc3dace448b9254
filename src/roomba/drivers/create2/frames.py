"""The stream of a Create 2: frames of packets, found among lost and garbled bytes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from roomba.drivers.create2.open_interface import HEADER, format_of

_MOST_BYTES: Final = 4096
"""Bytes that are kept; a frame has at most some hundred."""
Told = Mapping[int, int]


class FrameReader:
    """Finds frames of packets in bytes. ``spoilt`` counts headers that began no valid frame.

    One checksum in 256 is right by chance, so a frame must also have the layout of a list that was
    asked for.
    """

    def __init__(self, asked: Sequence[Sequence[int]]) -> None:
        """Read frames that are laid out as one of ``asked``, the lists that were asked for."""
        self._layouts = {
            sum(1 + format_of(packet).size for packet in packets): tuple(packets)
            for packets in asked
        }
        self._came = b""
        self.spoilt = 0

    def forget(self) -> None:
        """Forget the bytes of an unfinished frame."""
        self._came = b""

    def take(self, data: bytes) -> list[Told]:
        """Return the packets of each frame that is whole by now, by their numbers."""
        self._came = (self._came + data)[-_MOST_BYTES:]
        frames: list[Told] = []
        while True:
            start = self._came.find(HEADER)
            self._came = self._came[start:] if start >= 0 else b""
            if len(self._came) < 2:
                return frames
            size = self._came[1]
            if size in self._layouts and len(self._came) < size + 3:
                return frames
            told = self._told(size)
            if told is None:
                self.spoilt += 1
                self._came = self._came[1:]
                continue
            frames.append(told)
            self._came = self._came[size + 3 :]

    def _told(self, size: int) -> Told | None:
        """Return the packets of the frame that begins the buffer; None if it is not valid."""
        layout, frame = self._layouts.get(size), self._came[: size + 3]
        if layout is None or sum(frame) & 0xFF:
            return None
        told: dict[int, int] = {}
        place = 2
        for packet in layout:
            if frame[place] != packet:
                return None
            form = format_of(packet)
            (told[packet],) = form.unpack_from(frame, place + 1)
            place += 1 + form.size
        return told
