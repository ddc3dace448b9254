"""Rows of cells as bits, 64 a word, and jumps along them: compiled.

After the block search of Harabor & Grastien, "Improving jump point search", ICAPS 2014.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part

Bits = NDArray[np.uint64]

NOWHERE = -1
_ONE, _ZERO, _LAST_BIT = np.uint64(1), np.uint64(0), np.uint64(63)


def bit_rows(cells: NDArray[np.uint8]) -> Bits:
    """Return uint64 [rows + 2, words]: bit x + 1 of row y + 1 is cell (y, x); the border is 0."""
    rows, columns = cells.shape
    words = (columns + 2 + 63) // 64
    padded = np.zeros((rows + 2, 64 * words), np.uint8)
    padded[1:-1, 1 : columns + 1] = cells
    packed: Bits = np.packbits(padded, axis=1, bitorder="little").view("<u8")
    return packed


@inner_part
def bit_length(word: np.uint64) -> int:
    """Return how many bits a word has up to its highest 1; LLVM makes one instruction of it."""
    length = 0
    while word != _ZERO:
        word >>= _ONE
        length += 1
    return length


@entry
def is_set(bits: Bits, row: int, column: int) -> bool:
    """Whether a cell, counted with the border, may be entered."""
    return bool((bits[row, column >> 6] >> np.uint64(column & 63)) & _ONE)


@entry
def jump(bits: Bits, row: int, column: int, step: int, target: int) -> int:
    """Return the next cell of a row where a path may have to turn, or NOWHERE at a dead end.

    That is ``target``, or the cell just past a closed cell of the row above or below, whose corner
    could not be cut diagonally.
    """
    word = column >> 6
    place = np.uint64(column & 63)
    here, above, below = bits[row], bits[row + 1], bits[row - 1]
    all_bits = ~_ZERO
    if step > 0:
        wanted = (all_bits << place) << _ONE
        while True:
            carry_above = above[word - 1] >> _LAST_BIT if word > 0 else _ZERO
            carry_below = below[word - 1] >> _LAST_BIT if word > 0 else _ZERO
            turns = above[word] & ~((above[word] << _ONE) | carry_above)
            turns |= below[word] & ~((below[word] << _ONE) | carry_below)
            stops = (turns | ~here[word]) & wanted
            at = -1
            if stops != _ZERO:
                at = (word << 6) + bit_length(stops & (~stops + _ONE)) - 1
            if target > column and target >> 6 == word and (at < 0 or target <= at):
                return target
            if at >= 0:
                return at if is_set(bits, row, at) else NOWHERE
            word += 1
            wanted = all_bits
    wanted = (_ONE << place) - _ONE
    while True:
        last = word == bits.shape[1] - 1
        carry_above = _ZERO if last else above[word + 1] << _LAST_BIT
        carry_below = _ZERO if last else below[word + 1] << _LAST_BIT
        turns = above[word] & ~((above[word] >> _ONE) | carry_above)
        turns |= below[word] & ~((below[word] >> _ONE) | carry_below)
        stops = (turns | ~here[word]) & wanted
        at = -1
        if stops != _ZERO:
            at = (word << 6) + bit_length(stops) - 1
        if 0 <= target < column and target >> 6 == word and target >= at:
            return target
        if at >= 0:
            return at if is_set(bits, row, at) else NOWHERE
        word -= 1
        wanted = all_bits
