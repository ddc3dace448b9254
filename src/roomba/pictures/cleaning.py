"""A clean from the station and back: the path, the floor that was swept, and what was missed."""

from __future__ import annotations

from roomba.sim.plot import picture_of
from roomba.sim.runs import run_trial
from roomba.sim.trial import Trial
from roomba.world.home import Home
from roomba.world.plan_canvas import Picture


def picture_of_cleaning(home: Home, seed: int = 1, things: int = 2) -> Picture:
    """Draw a clean of a shipped home in which so many things stand that its map does not show."""
    return picture_of(run_trial(Trial(home=home.name, seed=seed, things=things)))
