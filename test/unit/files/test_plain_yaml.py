"""Plain YAML: it is read as PyYAML reads it, and no file hangs or ends the program."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.plain_yaml import DEEPEST, LONGEST, load_with_nodes, load_yaml

PLAIN: st.SearchStrategy[Any] = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)


@given(PLAIN)
def test_it_reads_what_was_written(value: Any) -> None:
    assert load_yaml(yaml.safe_dump(value)) == value


def test_the_tree_knows_the_lines() -> None:
    values, root = load_with_nodes("a: 1\nb:\n  - 2\n")
    assert values == {"a": 1, "b": [2]}
    assert isinstance(root, yaml.MappingNode)
    assert [key.start_mark.line for key, _ in root.value] == [0, 1]
    assert load_with_nodes("") == (None, None)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 200_000,
        "{a: " * 200_000,
        "- " * 200_000,
        "".join(f"{' ' * level}a:\n" for level in range(2000)),
        "[" * (DEEPEST + 1) + "]" * (DEEPEST + 1),
    ],
)
def test_deep_ones_are_refused_with_the_line(text: str) -> None:
    with pytest.raises(yaml.YAMLError, match=f"expected at most {DEEPEST} levels") as refused:
        load_yaml(text)
    assert isinstance(refused.value, yaml.MarkedYAMLError)
    assert refused.value.problem_mark is not None


def test_as_deep_as_allowed_is_read() -> None:
    value = load_yaml("[" * DEEPEST + "]" * DEEPEST)
    for _ in range(DEEPEST - 1):
        (value,) = value
    assert value == []


def bomb(begin: str, more: str) -> str:
    lines = [f"a0: &a0 {begin}"]
    for level in range(1, 12):
        lines.append(f"a{level}: &a{level} " + more.format(*[f"*a{level - 1}"] * 9))
    return "\n".join(lines)


@pytest.mark.parametrize(
    "text",
    [
        bomb("[x]", "[" + ", ".join(["{}"] * 9) + "]"),
        bomb("{x: 1}", "{{<<: [" + ", ".join(["{}"] * 9) + "]}}"),
    ],
    ids=["aliases", "merge keys"],
)
def test_values_that_aliases_repeat_count(text: str) -> None:
    assert len(text) < 1000
    with pytest.raises(yaml.YAMLError, match="with those that aliases repeat"):
        load_yaml(text)


def test_some_aliases_are_read() -> None:
    assert load_yaml("a: &a [1, 2]\nb: *a\nc: {<<: {d: 3}}") == {
        "a": [1, 2],
        "b": [1, 2],
        "c": {"d": 3},
    }


def test_long_ones_are_refused() -> None:
    with pytest.raises(yaml.YAMLError, match=f"at most {LONGEST} characters"):
        load_yaml(" " * (LONGEST + 1))


@pytest.mark.parametrize("text", ["!!python/object/apply:os.getcwd []", "a: !degrees 1+1"])
def test_no_tag_runs_code(text: str) -> None:
    with pytest.raises(yaml.YAMLError, match="could not determine a constructor"):
        load_yaml(text)


@pytest.mark.parametrize("text", ["a: 2026-05-40", "a: 0x", "? {a: 1}\n: b", "a: &a [*a]", "*b"])
def test_broken_yaml_raises_yaml_errors_only(text: str) -> None:
    with contextlib.suppress(yaml.YAMLError):
        load_yaml(text)


@given(st.text(alphabet="ab:-[]{}&*!|>?<'\"#% \n\t0.,", max_size=60))
def test_any_text_raises_yaml_errors_only(text: str) -> None:
    with contextlib.suppress(yaml.YAMLError):
        load_yaml(text)
