"""Compiled random numbers: each robot and world has its own generator, a single 64-bit number.

SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014): a
counter that goes on by a constant, and a hash of it. Saved and restored as one number, and the
same for a robot alone and among a thousand.
"""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import any_order_part, inner_part, part
from roomba.world.engine.state.arrays import Row

_GAMMA: Final = np.uint64(0x9E3779B97F4A7C15)
_MIX_1: Final = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2: Final = np.uint64(0x94D049BB133111EB)
_S30, _S27, _S31 = np.uint64(30), np.uint64(27), np.uint64(31)
_S11, _S52 = np.uint64(11), np.uint64(52)
_UNIT: Final = 1.0 / (1 << 53)

NORMAL_BITS: Final = 12


def normal_quantiles() -> NDArray[np.float32]:
    """Return the standard normal distribution as 4096 equally likely values, float32 [4096].

    Their standard deviation is 1 to 0.1 %, the largest is 3.67.
    """
    count = 1 << NORMAL_BITS
    normal = NormalDist()
    return np.array([normal.inv_cdf((index + 0.5) / count) for index in range(count)], np.float32)


@part
def next_bits(owner: Row) -> np.uint64:
    """Return 64 random bits; the ``random`` of a robot or a world goes on."""
    counter = np.uint64(owner.random + _GAMMA)
    owner.random = counter
    mixed = (counter ^ (counter >> _S30)) * _MIX_1
    mixed = (mixed ^ (mixed >> _S27)) * _MIX_2
    return np.uint64(mixed ^ (mixed >> _S31))


@part
def next_uniform(owner: Row) -> float:
    """Return a number of [0, 1)."""
    return float(next_bits(owner) >> _S11) * _UNIT


@part
def next_normal(owner: Row, quantiles: NDArray[np.float32]) -> float:
    """Return a number of the standard normal distribution (see :func:`normal_quantiles`)."""
    return float(quantiles[next_bits(owner) >> _S52])


@inner_part
def next_exponential(owner: Row) -> float:
    """Return a number of the exponential distribution with mean 1."""
    return -math.log(1.0 - next_uniform(owner))


@part
def hashed(bits: np.uint32) -> np.uint32:
    """Return Wellons' "lowbias32" of 32 bits."""
    bits = np.uint32(np.uint32(bits ^ (bits >> np.uint32(16))) * np.uint32(0x7FEB352D))
    bits = np.uint32(np.uint32(bits ^ (bits >> np.uint32(15))) * np.uint32(0x846CA68B))
    return np.uint32(bits ^ (bits >> np.uint32(16)))


@any_order_part
def add_noise(
    ranges: NDArray[np.float32],
    row: int,
    key: np.uint32,
    quantiles: NDArray[np.float32],
    sigma: np.float32,
    misses: np.float32,
) -> None:
    """Add normal noise of ``sigma`` m to a row of ranges, and lose the share ``misses`` of them.

    A lost range is inf; infinite ones stay so. Each beam has its own hash of ``key``: 12 bits
    choose the noise and 20 whether it is lost.
    """
    lost = np.uint32(misses * np.float32(1 << 20))
    for beam in range(ranges.shape[1]):
        bits = hashed(np.uint32(key + np.uint32(beam) * np.uint32(0x9E3779B9)))
        noisy = ranges[row, beam] + sigma * quantiles[bits & np.uint32(4095)]
        is_lost = np.uint32(bits >> np.uint32(12)) < lost
        ranges[row, beam] = np.float32(math.inf) if is_lost else noisy
