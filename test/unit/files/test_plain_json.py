"""Plain JSON: it comes back as written, and no text hangs or ends the program."""

import contextlib
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.plain_json import load_json

PLAIN: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)


@given(PLAIN)
def test_it_reads_what_was_written(value: Any) -> None:
    assert load_json(json.dumps(value)) == value


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"x": NaN}', "finite numbers, got NaN"),
        ("[-Infinity]", "finite numbers, got -Infinity"),
        ("[1e400]", "finite numbers, got 1e400"),
        ("[" * 200_000, "nests too deeply"),
        ('{"a":' * 200_000, "nests too deeply"),
        ("9" * 100_000, "digits"),
        ("", "Expecting value"),
    ],
)
def test_what_cannot_be_used_is_refused(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        load_json(text)


@given(st.text(alphabet='{}[],:"0123456789.eE-+ truefalsnNI', max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    with contextlib.suppress(ValueError):
        load_json(text)
