"""Numbers of the configuration that a trial changes, by dotted names: mission.coverage.turning.

The first word names the file whose number is replaced: ``robot``, ``simulation``, ``mission`` or
``docking``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final, TypeVar

from pydantic import BaseModel

from roomba.commands.options import UsageError
from roomba.commands.trials.trial import Setting
from roomba.configuration.frozen import validated
from roomba.configuration.sensors import SIMULATION

ROBOT, MISSION, DOCKING = "robot", "mission", "docking"
FILES: Final = (ROBOT, SIMULATION, MISSION, DOCKING)

_Model = TypeVar("_Model", bound=BaseModel)


def with_numbers(config: _Model, file: str, numbers: Iterable[Setting]) -> _Model:
    """Return a configuration with the numbers of a file changed.

    Raises ConfigError for one that does not exist or is out of its bounds.
    """
    changes: dict[str, Any] = {}
    for name, value in numbers:
        first, *words = name.split(".")
        if first == file and words:
            _put(changes, words, value)
    if not changes:
        return config
    merged = _merged(config.model_dump(), changes)
    return validated(type(config), merged, f"numbers: {file}.", "there is no such number")


def check_numbers(numbers: Iterable[Setting]) -> None:
    """Refuse names that belong to no file; raises UsageError."""
    for name, _ in numbers:
        first, *words = name.split(".")
        if first not in FILES or not all(words) or not words:
            raise UsageError(
                f"numbers: expected a name that begins with {', '.join(FILES)} and a point, "
                f"got {name!r}"
            )


def _put(changes: dict[str, Any], words: list[str], value: float | str) -> None:
    *folders, last = words
    for word in folders:
        changes = changes.setdefault(word, {})
    changes[last] = value


def _merged(values: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    merged = dict(values)
    for name, change in changes.items():
        below = merged.get(name)
        if isinstance(change, Mapping) and isinstance(below, Mapping):
            merged[name] = _merged(below, change)
        else:
            merged[name] = change
    return merged
