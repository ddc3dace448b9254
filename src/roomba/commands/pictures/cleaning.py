"""A clean from the station and back: the path, the floor that was swept, and what was missed."""

from __future__ import annotations

from roomba.commands.sim.plot import picture_of
from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.trial import Trial
from roomba.plots.canvas import Picture
from roomba.world.home.home import Home


def picture_of_cleaning(home: Home, seed: int = 1, things: int = 2) -> Picture:
    """Draw a clean of a shipped home in which so many things stand that its map does not show."""
    return picture_of(run_trial(Trial(home=home.name, seed=seed, things=things)))
