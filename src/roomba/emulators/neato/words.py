"""The command line of a Neato: words that may be shortened, values with names or in order.

Source: OpenNeato's page of the serial protocol, and the XV-11 programmer's manual it draws on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from roomba.errors import RoombaError


class CommandError(RoombaError):
    """What the robot answers to a command that it does not know."""


@dataclass(frozen=True, slots=True)
class Grammar:
    """A command: its flags, and its values in the order in which their names may be left out."""

    name: str
    flags: Sequence[str] = ()
    values: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Words:
    """A command that was understood: its flags, and its values by their names."""

    name: str
    flags: frozenset[str] = frozenset()
    values: Mapping[str, int] = field(default_factory=dict)


def understood(line: str, grammars: Sequence[Grammar]) -> Words:
    """Return what a line says; raises CommandError.

    Letters may be large or small, and words may be cut short where they stay unique. A word that is
    spelled out is understood even if a longer one begins with it.
    """
    if line[:1].isspace() or not line.split():
        raise CommandError(f"Unknown Cmd: '{line.strip()}'")
    first, *rest = line.split()
    grammar = {each.name: each for each in grammars}[_unique(first, [g.name for g in grammars])]
    flags: set[str] = set()
    values: dict[str, int] = {}
    unnamed = iter(grammar.values)
    words = iter(rest)
    for word in words:
        if (number := _whole(word)) is not None:
            name = next((name for name in unnamed if name not in values), None)
            if name is None:
                raise CommandError(f"Unrecognized Option: '{word}'")
            values[name] = number
            continue
        name = _unique(word, [*grammar.flags, *grammar.values], "Unrecognized Option: '{}'")
        if name in grammar.flags:
            flags.add(name)
            continue
        value = _whole(next(words, ""))
        if value is None:
            raise CommandError(f"Missing or invalid value of '{name}'")
        values[name] = value
    return Words(grammar.name, frozenset(flags), values)


def _unique(word: str, names: Sequence[str], complaint: str = "Unknown Cmd: '{}'") -> str:
    lowered = word.lower()
    exact = [name for name in names if name.lower() == lowered]
    begun = exact or [name for name in names if name.lower().startswith(lowered)]
    if len(begun) == 1:
        return begun[0]
    raise CommandError((complaint if not begun else "Ambiguous: '{}'").format(word))


def _whole(text: str) -> int | None:
    try:
        return int(text)
    except ValueError:
        return None
