"""The text of a CARMEN log: its lines, its parameters, and what in it is neither."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from roomba.recordings.carmen.lines import PARSERS, CarmenLine, finite, is_number
from roomba.recordings.packed import Unpacked
from roomba.recordings.readings import LogError

MOUNT_PARAMETERS: Final = (
    "robot_frontlaser_offset",
    "robot_frontlaser_side_offset",
    "robot_frontlaser_angular_offset",
)
"""Parameters that tell where the laser is: x, y, m, and theta, rad, of the robot's frame."""
_EXPECTED: Final = f"expected lines {', '.join(PARSERS)} of a CARMEN log"
_LISTED: Final = 10
"""First words of a file that is no log, in its refusal."""
_LONGEST: Final = 30
"""Characters of each."""
_LONGEST_REASON: Final = 80
"""Characters of why a line cannot be read."""


class CarmenText:
    """A text that was read: its ``lines``, at least one, and the ``notes`` on what was left out.

    ``parameters`` are those of :data:`MOUNT_PARAMETERS` that it tells; ``other`` counts lines of
    other kinds by their first word.
    """

    def __init__(self, path: Path) -> None:
        """Read all of it; raises LogError when there is no line of a log."""
        self.notes: list[str] = []
        self.parameters: dict[str, float] = {}
        self.other: Counter[str] = Counter()
        self._broken = 0
        self._first_broken = ""
        self.lines = self._read(path)
        if self._broken:
            self.notes.append(
                f"{self._broken} lines of {path.name} cannot be read: left out (the first: "
                f"{self._first_broken})"
            )
        if not self.lines:
            self._refuse_numbers(path)
            there = self.notes or [f"it has {_shown(self.other) or 'nothing'}"]
            raise LogError(f"{path}: {_EXPECTED}, got none; {'; '.join(there)}")

    def _read(self, path: Path) -> list[CarmenLine]:
        file = Unpacked(path)
        try:
            # Some editors put a mark before the first line, which is no part of its first word.
            with file.path.open(encoding="utf-8-sig", errors="replace") as text:
                lines = (self._parse(number, each.split()) for number, each in enumerate(text, 1))
                return [line for line in lines if line is not None]
        finally:
            file.close()

    def _parse(self, number: int, words: list[str]) -> CarmenLine | None:
        if not words or words[0].startswith("#"):
            return None
        word = words[0]
        parse = PARSERS.get(word)
        if parse is None and word != "PARAM":
            self.other[word] += 1
            return None
        try:
            if parse is not None:
                return parse(words)
            if words[1] in MOUNT_PARAMETERS:
                self.parameters[words[1]] = finite(words[2])
        except IndexError:
            self._note_broken(number, word, f"it has {len(words)} words only")
        except ValueError as error:
            self._note_broken(number, word, str(error))
        return None

    def _note_broken(self, number: int, word: str, reason: str) -> None:
        self._broken += 1
        if not self._first_broken:
            self._first_broken = f"line {number}, {word}: {_cut(reason, _LONGEST_REASON)}"

    def _refuse_numbers(self, path: Path) -> None:
        """Refuse a text most of whose lines begin with a number; raises LogError."""
        numbers = [word for word in self.other if is_number(word)]
        if 2 * sum(self.other[word] for word in numbers) > self.other.total():
            raise LogError(
                f"{path}: {_EXPECTED}, got lines that begin with numbers, as "
                f"{_cut(numbers[0], _LONGEST)}: a line of a CARMEN log begins with what it tells, "
                "as `FLASER 3 1.5 1.6 1.4 0 0 0 0 0 0 12.5 host 12.5`, of three ranges, two poses "
                "and its time"
            )


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else f"{text[:longest]}…"


def _shown(words: Iterable[str]) -> str:
    """Return the first words, each cut: a file of another kind may be one long word, or many."""
    shown = [_cut(word, _LONGEST) for word in words]
    return ", ".join(shown[:_LISTED]) + (", …" if len(shown) > _LISTED else "")
