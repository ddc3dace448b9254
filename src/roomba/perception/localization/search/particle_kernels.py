"""Compiled steps of a particle filter over the places of a map: move, weigh, resample, sum up."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, entry
from roomba.perception.matching.field_kernels import Field, Place

Particles = NDArray[np.float64]
"""[n, 4]: x, y (m), theta (rad), and the logarithm of the weight."""


@entry
def spread_over(spots: Floats, headings: int, particles: Particles) -> None:
    """Fill ``particles`` with each spot, [m, 2], m, in ``headings`` headings, all of weight 1."""
    turn = 2.0 * math.pi / headings
    for index in range(particles.shape[0]):
        spot, heading = index // headings, index % headings
        particles[index, 0], particles[index, 1] = spots[spot, 0], spots[spot, 1]
        particles[index, 2] = -math.pi + (heading + (spot % 4) * 0.25) * turn
        particles[index, 3] = 0.0


@entry
def move_all(particles: Particles, x: float, y: float, turn: float, noise: Floats) -> None:
    """Move all particles by a step in their own frames, m and rad, plus ``noise`` [n, 3] each."""
    for index in range(particles.shape[0]):
        cosine, sine = math.cos(particles[index, 2]), math.sin(particles[index, 2])
        ahead, aside = x + noise[index, 0], y + noise[index, 1]
        particles[index, 0] += cosine * ahead - sine * aside
        particles[index, 1] += sine * ahead + cosine * aside
        particles[index, 2] += turn + noise[index, 2]


@entry
def fill_likelihoods(
    field: Field, depth: float, spread: float, chance: float, likelihoods: Field
) -> None:
    """Fill ``likelihoods`` with the logarithm of how likely a beam ends in each cell of a field.

    On a surface, or less than ``depth`` m behind one, that is 0; farther off it is that of a
    Gaussian with deviation ``spread``, m, but never less than that of ``chance``.
    Source: the likelihood field of Thrun, Burgard, Fox, "Probabilistic Robotics", 2005, 6.4.
    """
    rows, columns = field.shape
    less = 0.5 / (spread * spread)
    for row in range(rows):
        for column in range(columns):
            off = field[row, column]
            off = off if off > 0.0 else max(0.0, -off - depth)
            likely = chance + (1.0 - chance) * math.exp(-off * off * less)
            likelihoods[row, column] = math.log(likely)


@entry
def weigh_all(
    likelihoods: Field,
    place: Place,
    ends: Floats,
    chosen: NDArray[np.int64],
    share: float,
    outside: float,
    particles: Particles,
) -> None:
    """Add to each particle's weight the likelihood of the beams there, each times ``share``.

    ``chosen`` are rows of ``ends`` (see ``beam_ends``); a beam that ends off the map counts
    ``outside``.
    """
    rows, columns = likelihoods.shape
    inverse = 1.0 / place[2]
    for index in range(particles.shape[0]):
        x, y, theta = particles[index, 0], particles[index, 1], particles[index, 2]
        cosine, sine = math.cos(theta) * inverse, math.sin(theta) * inverse
        u, v = (x - place[0]) * inverse + 0.5, (y - place[1]) * inverse + 0.5
        total = 0.0
        for number in range(chosen.size):
            end_x, end_y = ends[chosen[number], 0], ends[chosen[number], 1]
            column = math.floor(u + cosine * end_x - sine * end_y)
            row = math.floor(v + sine * end_x + cosine * end_y)
            if 0 <= column < columns and 0 <= row < rows:
                total += likelihoods[int(row), int(column)]
            else:
                total += outside
        particles[index, 3] += share * total


@entry
def leave_walls(field: Field, place: Place, room: float, particles: Particles) -> None:
    """Take the weight of all particles that have less than ``room`` m around them."""
    rows, columns = field.shape
    inverse = 1.0 / place[2]
    for index in range(particles.shape[0]):
        u = (particles[index, 0] - place[0]) * inverse + 0.5
        v = (particles[index, 1] - place[1]) * inverse + 0.5
        if not (0.0 <= u < columns and 0.0 <= v < rows) or field[int(v), int(u)] < room:
            particles[index, 3] = -math.inf


@allocating_entry
def resample(particles: Particles, weights: Floats, start: float, chosen: Particles) -> None:
    """Fill ``chosen`` [m, 4] from ``particles`` by their ``weights`` [n], which sum up to 1.

    This is low-variance resampling: at even steps, the first at ``start``, 0..1 of a step.
    """
    count, at, sum_of = chosen.shape[0], 0, weights[0]
    for index in range(count):
        wanted = (start + index) / count
        while sum_of < wanted and at < weights.size - 1:
            at += 1
            sum_of += weights[at]
        for axis in range(3):
            chosen[index, axis] = particles[at, axis]
        chosen[index, 3] = 0.0


@entry
def normalise(particles: Particles, weights: Floats) -> float:
    """Fill ``weights`` [n], summing up to 1; return the effective number of particles.

    It is 0 if none has any weight; ``weights`` is not filled then.
    """
    count = particles.shape[0]
    most = -math.inf
    for index in range(count):
        most = max(most, particles[index, 3])
    if most == -math.inf:
        return 0.0
    total = squares = 0.0
    for index in range(count):
        weights[index] = math.exp(particles[index, 3] - most)
        total += weights[index]
    for index in range(count):
        weights[index] /= total
        squares += weights[index] * weights[index]
    return 1.0 / squares


@entry
def weight_around(
    particles: Particles, weights: Floats, at: Floats, near: float, turned: float, middle: Floats
) -> float:
    """Return the weight near ``at`` [3] and fill ``middle`` [3] with its mean pose.

    Particles less than ``near`` m off and ``turned`` rad turned are near.
    """
    total = x = y = sine = cosine = 0.0
    for index in range(particles.shape[0]):
        off_x, off_y = particles[index, 0] - at[0], particles[index, 1] - at[1]
        turn = (particles[index, 2] - at[2] + math.pi) % (2.0 * math.pi) - math.pi
        if off_x * off_x + off_y * off_y > near * near or abs(turn) > turned:
            continue
        weight = weights[index]
        total += weight
        x += weight * off_x
        y += weight * off_y
        sine += weight * math.sin(turn)
        cosine += weight * math.cos(turn)
    if total > 0.0:
        middle[0], middle[1] = at[0] + x / total, at[1] + y / total
        middle[2] = at[2] + math.atan2(sine, cosine)
    return total
