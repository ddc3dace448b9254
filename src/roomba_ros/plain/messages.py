"""Any ROS message as plain values for JSON, and back, as rosbridge v2 writes them.

Numbers that are not finite are null, bytes (``uint8[]``, ``char[]``) are base64, and times are
``{"secs": s, "nsecs": ns}``.
"""

from __future__ import annotations

import base64
import binascii
import math
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final

import genpy
import roslib.message

from roomba_ros.convert.errors import MessageError

MOST_ELEMENTS: Final = 2_000_000
"""Of an array that becomes JSON; a map of 70 x 70 m has them."""
_TYPE: Final = re.compile(r"[A-Za-z]\w*/[A-Za-z]\w*", re.ASCII)
_FLOAT32_MAX: Final = 3.4028235e38
_INTEGERS: Final = {
    **{f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
    "byte": (-128, 127),
    "char": (0, 255),
}
_BYTES: Final = ("uint8", "char")
_FLOATS: Final = ("float32", "float64")
_HEADERS: Final = ("Header", "std_msgs/Header", "roslib/Header")
_TIMES: Final = {"time": genpy.Time, "duration": genpy.Duration}

Encoder = Callable[[Any], Any]


def class_of(kind: str) -> type:
    """Return the class of a type such as ``std_msgs/String``; raises MessageError."""
    require_generated(kind, "msg")
    found: type = roslib.message.get_message_class(kind)
    return found


def require_generated(kind: str, folder: str) -> None:
    """Raise MessageError unless a type has generated code in the package's ``msg`` or ``srv``.

    A type is imported by its name, and importing an arbitrary package would run its code.
    """
    package, _, name = kind.partition("/")
    is_name = _TYPE.fullmatch(kind) is not None
    if not is_name or not any(
        (Path(entry) / package / folder / f"_{name}.py").is_file() for entry in sys.path
    ):
        raise MessageError(f"expected a type of {folder} that is installed, got {kind[:80]!r}")


def plain_of(message: Any) -> dict[str, Any]:
    """Return a message's fields as values for JSON; raises MessageError for a huge array."""
    kind: Any = type(message)
    return {name: encode(getattr(message, name)) for name, encode in _encoders(kind)}


@cache
def _encoders(kind: Any) -> tuple[tuple[str, Encoder], ...]:
    slots, types = kind.__slots__, kind._slot_types
    return tuple((name, _encoder(its)) for name, its in zip(slots, types, strict=True))


@cache
def _encoder(kind: str) -> Encoder:
    base, is_array, _ = parse_type(kind)
    if not is_array:
        return _encoder_of_one(base)
    if base in _BYTES:
        return lambda value: base64.b64encode(_bounded(bytes(value))).decode("ascii")
    if base in _FLOATS:
        return _finite_list
    if base in _INTEGERS or base in ("bool", "string"):
        return lambda values: list(_bounded(values))
    encode = _encoder_of_one(base)
    return lambda values: [encode(value) for value in _bounded(values)]


def _encoder_of_one(base: str) -> Encoder:
    if base in _FLOATS:
        return lambda value: value if math.isfinite(value) else None
    if base in _TIMES:
        return lambda value: {"secs": value.secs, "nsecs": value.nsecs}
    if base in _INTEGERS or base == "string":
        return lambda value: value
    if base == "bool":
        return bool
    return plain_of


def _finite_list(values: Any) -> list[float | None]:
    if all(map(math.isfinite, _bounded(values))):
        return list(values)
    return [value if math.isfinite(value) else None for value in values]


def _bounded(values: Any) -> Any:
    if len(values) > 4 * MOST_ELEMENTS or (
        len(values) > MOST_ELEMENTS and not isinstance(values, bytes)
    ):
        raise MessageError(
            f"expected an array of at most {MOST_ELEMENTS} values, or {4 * MOST_ELEMENTS} bytes, "
            f"got {len(values)}; read this topic by ROS itself"
        )
    return values


def message_from(kind: type, plain: Any, now: genpy.Time) -> Any:
    """Return a message of a class from plain values; what they leave out is as by default.

    A header without a stamp gets ``now``. Raises MessageError for fields that there are not, and
    for values that do not fit.
    """
    message = kind()
    fill(message, plain, now)
    return message


def fill(message: Any, plain: Any, now: genpy.Time, where: str = "") -> None:
    """Set the fields of a message that plain values name; raises MessageError."""
    name_of_type = message._type
    if not isinstance(plain, dict):
        raise _wrong(where or "the message", f"an object ({name_of_type})", plain)
    types = dict(zip(message.__slots__, message._slot_types, strict=True))
    for name, value in plain.items():
        if name not in types:
            has = ", ".join(types) or "none"
            raise MessageError(f"{name_of_type} has no field {str(name)[:80]!r}; it has {has}")
        path = f"{where}.{name}" if where else name
        setattr(message, name, _decoded(types[name], value, now, path))
    if name_of_type in _HEADERS and "stamp" not in plain:
        message.stamp = now
    elif not where and types.get("header") in _HEADERS and "header" not in plain:
        message.header.stamp = now


def _decoded(kind: str, value: Any, now: genpy.Time, where: str) -> Any:
    base, is_array, length = parse_type(kind)
    if not is_array:
        return _decode_one(base, value, now, where)
    if base in _BYTES and isinstance(value, str):
        values: Any = _decoded_bytes(value, where)
    elif isinstance(value, list):
        values = [
            _decode_one(base, one, now, f"{where}[{index}]") for index, one in enumerate(value)
        ]
        values = bytes(values) if base in _BYTES else values
    else:
        raise _wrong(where, "an array", value)
    if length is not None and len(values) != length:
        raise MessageError(f"{where}: expected {length} values, got {len(values)}")
    return values


def _decode_one(base: str, value: Any, now: genpy.Time, where: str) -> Any:
    if base in _FLOATS:
        return _decoded_float(base, value, where)
    if base in _INTEGERS:
        return _decoded_integer(base, value, where)
    if base == "bool":
        if not isinstance(value, bool):
            raise _wrong(where, "true or false", value)
        return value
    if base == "string":
        return _decoded_text(value, where)
    if base in _TIMES:
        return _decoded_time(base, value, now, where)
    message = class_of(base)()
    fill(message, value, now, where)
    return message


def _decoded_text(value: Any, where: str) -> str:
    if not isinstance(value, str):
        raise _wrong(where, "a text", value)
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise MessageError(f"{where}: expected a text of whole characters: {error}") from error
    return value


def _decoded_float(base: str, value: Any, where: str) -> float:
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise _wrong(where, "a number", value)
    try:
        number = float(value)
    except OverflowError as error:
        raise _wrong(where, "a number", value) from error
    if base == "float32" and math.isfinite(number) and abs(number) > _FLOAT32_MAX:
        raise _wrong(where, "a number of 32 bits", value)
    return number


def _decoded_integer(base: str, value: Any, where: str) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    least, most = _INTEGERS[base]
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise _wrong(where, f"a whole number from {least} to {most}", value)
    return value


def _decoded_time(base: str, value: Any, now: genpy.Time, where: str) -> Any:
    if base == "time" and value == "now":
        return now
    if not isinstance(value, dict) or not set(value) <= {"secs", "nsecs"}:
        raise _wrong(where, 'a time, {"secs": …, "nsecs": …}', value)
    whole = "uint32" if base == "time" else "int32"
    seconds = _decoded_integer(whole, value.get("secs", 0), f"{where}.secs")
    return _TIMES[base](seconds, _decoded_integer(whole, value.get("nsecs", 0), f"{where}.nsecs"))


def _decoded_bytes(text: str, where: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise MessageError(f"{where}: expected bytes as base64: {error}") from error


def _wrong(where: str, expected: str, value: Any) -> MessageError:
    return MessageError(f"{where}: expected {expected}, got {repr(value)[:80]}")


def parse_type(kind: str) -> tuple[str, bool, int | None]:
    """Return the base of a field's type, whether it is an array, and of which fixed length."""
    base, bracket, length = kind.partition("[")
    return base, bool(bracket), int(length[:-1]) if length[:-1] else None
