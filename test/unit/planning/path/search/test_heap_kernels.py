"""The 4-ary heap, against heapq."""

from __future__ import annotations

import heapq

import numpy as np
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.planning.path.search.heap_kernels import heap_pop, heap_push

STEPS = st.lists(st.one_of(st.none(), st.integers(-20, 20)), max_size=60)
"""Keys to push, and None for a pop; few different keys, so that many are equal."""


@given(STEPS)
@settings(max_examples=examples(150))
def test_the_least_key_is_always_first_and_no_item_is_lost(steps: list[int | None]) -> None:
    keys, items = np.full(len(steps), np.nan), np.full(len(steps), -1, np.int32)
    expected: list[tuple[float, int]] = []
    size = 0
    for item, key in enumerate(steps):
        if key is not None:
            heap_push(keys, items, size, float(key), item)
            heapq.heappush(expected, (float(key), item))
            size += 1
        elif size > 0:
            # Of items with the same key any may come first.
            assert keys[0] == expected[0][0]
            expected.remove((float(keys[0]), int(items[0])))
            heapq.heapify(expected)
            heap_pop(keys, items, size)
            size -= 1
        assert sorted(zip(keys[:size], items[:size], strict=True)) == sorted(expected)


@given(st.lists(st.floats(allow_nan=False), max_size=80))
@settings(max_examples=examples(100))
def test_popping_all_sorts_the_keys(values: list[float]) -> None:
    keys, items = np.empty(len(values)), np.empty(len(values), np.int32)
    for size, value in enumerate(values):
        heap_push(keys, items, size, value, size)
    popped = []
    for size in range(len(values), 0, -1):
        assert values[items[0]] == keys[0]
        popped.append(float(keys[0]))
        heap_pop(keys, items, size)
    assert popped == sorted(values)
