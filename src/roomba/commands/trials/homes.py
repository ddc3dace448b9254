"""The home of a trial: from files or made by the seed; with doors shut and turned, if asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import shapely

from roomba.commands.options import UsageError
from roomba.commands.trials.trial import RANDOM, Trial
from roomba.configuration.body import BodyConfig
from roomba.errors import RoomsError
from roomba.files.shipped import HOMES
from roomba.grid import FREE
from roomba.perception.rooms.rooms import Rooms, segment
from roomba.world.home.doors import with_leaves
from roomba.world.home.home import Home, MovingKind
from roomba.world.home.raster import covered_cells, outline
from roomba.world.home.turned import turned_home, with_steps
from roomba.world.layers.layer import load_home
from roomba.world.random.home import random_home


def home_of(trial: Trial, body: BodyConfig) -> Home:
    """Return the home; raises HomeError, and UsageError for a station of a random home."""
    if trial.home == RANDOM:
        if trial.station is not None:
            raise UsageError("--station: expected a home of a file, got a random one")
        home = random_home(trial.seed, body)
    else:
        home = load_home(trial.home, HOMES, body, trial.station)
    home = with_doors_shut(home) if trial.shut_doors else home
    return turned_home(home, math.radians(trial.turned)) if trial.turned else home


def playable_home_of(trial: Trial, body: BodyConfig) -> Home:
    """Return the home of a trial with doors that can be shut while the robot lives in it."""
    return with_leaves(home_of(trial, body))


def with_doors_shut(home: Home) -> Home:
    """Return a home whose doors are shut and stay so; the map still shows them open."""
    if not home.doors:
        return home
    if home.turned is not None:
        return with_steps(with_doors_shut(home.exact))
    shut = covered_cells(home.frame, (outline(door.opening) for door in home.doors))
    return replace(
        home,
        solid=home.solid | shut,
        doors=tuple(replace(door, is_open=False) for door in home.doors),
        moving=tuple(thing for thing in home.moving if thing.kind is not MovingKind.DOOR),
    )


def rooms_of(home: Home) -> Rooms:
    """Return the rooms as the home's layer names them, else as its map shows them.

    A room that lies within another one is cut out of that one.
    """
    names = [room.name for room in home.rooms]
    outlines = _apart([shapely.Polygon(room.outline) for room in home.rooms])
    if names:
        try:
            named = list(zip(names, outlines, strict=True))
            return Rooms.from_outlines(home.frame, home.map.values == FREE, named)
        except RoomsError:
            # A layer's outlines are for people and may overlap; the robot's own rooms must not.
            pass
    return segment(home.map)


def _apart(outlines: Sequence[shapely.Polygon]) -> list[shapely.Geometry]:
    """Return outlines, from each of which those within it are cut out."""
    apart = []
    for room in outlines:
        within = [each for each in outlines if each is not room and room.contains(each)]
        apart.append(room - shapely.union_all(within) if within else room)
    return apart
