"""Definitions of types, as rosapi tells them."""

from __future__ import annotations

from typing import Any, Final

import genpy

from roomba_ros.plain.messages import class_of, parse_type

_TIMES: Final = ("time", "duration")


def details_of(kind: type) -> list[dict[str, Any]]:
    """Return the definition of a type, and of all types in it, each once."""
    found: dict[str, dict[str, Any]] = {}
    _add(kind, found)
    return list(found.values())


def _add(kind: Any, found: dict[str, dict[str, Any]]) -> None:
    if kind._type in found:
        return
    found[kind._type] = definition = _definition(kind)
    for name in definition["fieldtypes"]:
        if "/" in name:
            _add(class_of(name), found)


def _definition(kind: Any) -> dict[str, Any]:
    types, lengths = [], []
    for slot in kind._slot_types:
        base, is_array, length = parse_type(slot)
        types.append("std_msgs/Header" if base == "Header" else base)
        lengths.append((length or 0) if is_array else -1)
    constants = _constants(kind)
    return {
        "type": kind._type,
        "fieldnames": list(kind.__slots__),
        "fieldtypes": types,
        "fieldarraylen": lengths,
        "examples": [_example(base, length) for base, length in zip(types, lengths, strict=True)],
        "constnames": list(constants),
        "constvalues": [str(value) for value in constants.values()],
    }


def _constants(kind: Any) -> dict[str, Any]:
    return {
        name: value
        for name, value in vars(kind).items()
        if not name.startswith("_")
        and name not in kind.__slots__
        and isinstance(value, (int, float, str))
    }


def _example(base: str, length: int) -> str:
    if length >= 0:
        return "[]"
    if base in _TIMES:
        return "{'secs': 0, 'nsecs': 0}"
    if "/" in base:
        return "{}"
    return {"string": "", "bool": "False", "float32": "0.0", "float64": "0.0"}.get(base, "0")


def full_text(kind: Any) -> str:
    """Return the whole definition of a type as text, all types in it included."""
    return str(kind._full_text)


def time_now(now: genpy.Time) -> dict[str, Any]:
    """Return the answer about the time."""
    return {"time": {"secs": now.secs, "nsecs": now.nsecs}}
