"""The songs of a Create 2: up to five, of sixteen notes each."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

MOST: Final = 5
MOST_NOTES: Final = 16
_NOTE: Final = 64.0
"""Units of a note's length in a second."""


@dataclass(slots=True)
class Songs:
    """``notes`` by the number of the song: pitch and length by turns, as they were told.

    ``number`` is that of the song which plays, or was played last.
    """

    notes: dict[int, bytes] = field(default_factory=dict)
    number: int = 0
    _left: float = 0.0

    def keep(self, number: int, notes: bytes) -> None:
        """Keep a song; one with a number or a length that is not allowed is passed over."""
        if number < MOST and 2 <= len(notes) <= 2 * MOST_NOTES:
            self.notes[number] = notes

    def play(self, number: int) -> None:
        """Play a song; while one plays, or where there is none, nothing happens."""
        if self.is_playing or number not in self.notes:
            return
        self.number = number
        self._left = sum(self.notes[number][1::2]) / _NOTE

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        self._left = max(0.0, self._left - seconds)

    @property
    def is_playing(self) -> bool:
        """Whether a song sounds."""
        return self._left > 0.0
