"""A compiled 4-ary min-heap: flatter than a binary one, and a node's children share a cache line.

``keys`` is float64 [n], ``items`` int32 [n]; the caller keeps the size.
"""

from __future__ import annotations

from roomba.arrays import Floats, Ints32
from roomba.compilation import entry


@entry
def heap_push(keys: Floats, items: Ints32, size: int, key: float, item: int) -> None:
    """Put an item into a 4-ary min-heap of ``size`` items."""
    at = size
    while at > 0:
        above = (at - 1) >> 2
        if keys[above] <= key:
            break
        keys[at] = keys[above]
        items[at] = items[above]
        at = above
    keys[at] = key
    items[at] = item


@entry
def heap_pop(keys: Floats, items: Ints32, size: int) -> None:
    """Remove the first item of a 4-ary min-heap of ``size`` items."""
    last = size - 1
    key, item = keys[last], items[last]
    at = 0
    while True:
        below = 4 * at + 1
        if below >= last:
            break
        least = below
        for other in range(below + 1, min(below + 4, last)):
            if keys[other] < keys[least]:
                least = other
        if keys[least] >= key:
            break
        keys[at] = keys[least]
        items[at] = items[least]
        at = least
    keys[at] = key
    items[at] = item
