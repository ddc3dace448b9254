"""Compiled measuring of those connections of a tour whose lengths were guessed.

Only the ways to near ends are searched for beforehand. If a tour connects ends that are farther
apart and out of sight of each other, the guess may be far too short, as a wall may lie between.
"""

from __future__ import annotations

import math

import numpy as np

from roomba.compilation import allocating_entry, inner_part
from roomba.planning.coverage.tour.costs import Costs, Tour, cost_of, note_pair, turns_between
from roomba.planning.coverage.tour.net import Net
from roomba.planning.coverage.tour.ways import way_between

_OFF = 1.0
"""cells; a guess that is off by less stays."""


@allocating_entry
def guesses_measured(net: Net, costs: Costs, tour: Tour) -> int:
    """Store the true costs of the guessed connections of a tour in ``costs``.

    Returns how many of them cost more than was guessed.
    """
    room = np.full(net.links.size // 8, np.inf)
    more = 0
    last = tour.size - 3 if costs.loose else tour.size - 1
    for at in range(1, last, 2):
        one, other = tour[at], tour[at + 1]
        if _was_searched(costs, one, other):
            continue
        x, y = costs.at[one]
        to_x, to_y = costs.at[other]
        way = way_between(net, room, x, y, to_x, to_y)
        length = 0.0
        for leg in range(1, len(way)):
            length += math.hypot(way[leg, 0] - way[leg - 1, 0], way[leg, 1] - way[leg - 1, 1])
        if length == 0.0:
            continue
        true = length + costs.turning * turns_between(costs, one, other)
        guess = cost_of(costs, one, other)
        if abs(true - guess) > _OFF:
            note_pair(costs, one, other, true)
            more += true > guess
    return more


@inner_part
def _was_searched(costs: Costs, one: int, other: int) -> bool:
    """Whether one of two ends is among those near the other."""
    for k in range(costs.nearest.shape[1]):
        if costs.nearest[one, k] == other or costs.nearest[other, k] == one:
            return True
    return False
