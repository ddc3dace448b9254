"""Any message becomes a value, or is refused by MessageError, within a short time.

``ROOMBA_EXAMPLES=5000`` tries so many of each kind, others each time.
"""

from __future__ import annotations

import importlib
import inspect
import io
import os
import pkgutil
import time
from collections.abc import Callable, Iterator
from typing import Any, Final, get_type_hints

import genpy
import pytest
from fixtures.spoiled import NUMBERS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from roslib.message import get_message_class

import roomba_ros.convert
from roomba.perception.rooms.zones import ZonesError
from roomba_ros.convert.errors import MessageError

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 25,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
SOON: Final = 5.0
"""s of processor time."""
OF_SERVICES: Final = {"zone_of": ZonesError}
"""What a service hears and answers by its own error."""
FLOATS: Final = st.one_of(
    st.floats(-10.0, 10.0), st.floats(), st.sampled_from([float(number) for number in NUMBERS])
)
WHOLE: Final = {
    f"{sign}int{bits}": st.one_of(
        st.integers(0, 6),
        st.integers(
            0 if sign else -(2 ** (bits - 1)), 2**bits - 1 if sign else 2 ** (bits - 1) - 1
        ),
    )
    for sign in ("", "u")
    for bits in (8, 16, 32, 64)
}
PLAIN: Final[dict[str, st.SearchStrategy[Any]]] = {
    **WHOLE,
    "bool": st.booleans(),
    "byte": WHOLE["int8"],
    "char": WHOLE["uint8"],
    "float32": st.one_of(st.floats(width=32), st.floats(-10.0, 10.0, width=32)),
    "float64": FLOATS,
    "string": st.one_of(
        st.sampled_from(["", "map", "odom", "base_link", "hall"]), st.text(max_size=99)
    ),
    "time": st.builds(genpy.Time, st.integers(0, 2**32 - 1), st.integers(0, 999_999_999)),
    "duration": st.builds(genpy.Duration, st.integers(-9, 9), st.integers(0, 999_999_999)),
}


def values(kind: str) -> st.SearchStrategy[Any]:
    """Return any value of a field."""
    if kind.endswith("]"):
        of, _, size = kind[:-1].partition("[")
        if of in ("uint8", "char"):
            return st.binary(min_size=int(size or 0), max_size=int(size or 40))
        return st.lists(values(of), min_size=int(size or 0), max_size=int(size or 5))
    return PLAIN[kind] if kind in PLAIN else messages(get_message_class(kind))


def messages(kind: Any) -> st.SearchStrategy[Any]:
    """Return any message of a type."""
    fields = dict(zip(kind.__slots__, kind._slot_types, strict=True))
    return st.builds(kind, **{name: values(type_) for name, type_ in fields.items()})


def converters() -> Iterator[tuple[str, Any, Callable[[Any], Any]]]:
    """Return all functions that make a value of one message, with its type."""
    for found in pkgutil.iter_modules(roomba_ros.convert.__path__):
        module = importlib.import_module(f"roomba_ros.convert.{found.name}")
        for name, function in inspect.getmembers(module, inspect.isfunction):
            if function.__module__ != module.__name__ or name.startswith("_"):
                continue
            hints = get_type_hints(function)
            hints.pop("return", None)
            kinds = list(hints.values())
            if (
                len(kinds) == 1
                and isinstance(kinds[0], type)
                and issubclass(kinds[0], genpy.Message)
            ):
                yield f"{found.name}.{name}", kinds[0], function


CONVERTERS: Final = list(converters())


def test_the_functions_are_found() -> None:
    names = {name for name, _, _ in CONVERTERS}
    assert {"common.twist_of", "common.map_of", "rooms.zones_of", "readings.odometry_of"} <= names
    assert len(names) > 20


@pytest.mark.parametrize(
    ("kind", "convert"), [row[1:] for row in CONVERTERS], ids=[row[0] for row in CONVERTERS]
)
def test_a_message_is_converted_or_refused(kind: Any, convert: Callable[[Any], Any]) -> None:
    @FUZZ
    @given(messages(kind))
    def try_one(message: Any) -> None:
        sent = io.BytesIO()
        message.serialize(sent)
        heard = kind().deserialize(sent.getvalue())
        began, refusal = time.process_time(), "none"
        try:
            convert(heard)
        except (MessageError, OF_SERVICES.get(convert.__name__, MessageError)) as error:
            refusal = str(error)
        assert 0 < len(refusal) < 2000
        assert time.process_time() - began < SOON

    try_one()
