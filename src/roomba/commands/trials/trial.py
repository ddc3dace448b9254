"""The specification of a run: one value with all that determines it, which processes can send."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from roomba.clean_request import CleanRequest, Rectangle
from roomba.geometry import Pose

if TYPE_CHECKING:
    from roomba.configuration.simulation import Sensors, Wheels

RANDOM: Final = "random"
"""The name of a home that the seed makes."""
MOST_THINGS: Final = 16
"""The most things in one world: see :data:`roomba.world.engine.state.arrays.MOST_DISCS`."""

Setting = tuple[str, float | str]
"""The dotted name of a number of the configuration, and its value."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One run: the same trial gives the same run, bit for bit, but for the times that it takes.

    ``home`` is a name or a path as :func:`roomba.world.layers.layer.load_home` takes it, or RANDOM.
    ``seed`` decides about noise, where ``things`` stand, and a random home. ``sensors`` replaces
    what the configuration file ``config`` says, ``lidar`` the lidar by one of the names of
    :func:`roomba.configuration.sensors.lidar_models`, ``wheels`` the robot's condition. ``station``
    is the pose of the docked robot in place of the home's own. ``battery`` is its charge at the
    start, 0..1. ``bin`` is how much its dust bin takes, g, in place of what the configuration
    says; ``empties_bin_after`` s of standing with a full one it is emptied. ``turned`` is by how
    many degrees, counter-clockwise, the home is turned about the origin of its map; ``station``
    turns with it. ``numbers`` are numbers of the configuration in place of what the files say, as
    of :mod:`roomba.commands.trials.numbers`; ``stages`` are stages of planning coverage by import
    path, as of :mod:`roomba.commands.trials.stages`, also of modules in the folder ``code``.
    """

    home: str = "flat"
    seed: int = 0
    request: CleanRequest = field(default_factory=CleanRequest)
    sensors: Sensors | None = None
    lidar: str | None = None
    wheels: Wheels | None = None
    no_go: tuple[Rectangle, ...] = ()
    things: int = 0
    shut_doors: bool = False
    battery: float = 1.0
    station: Pose | None = None
    config: Path | None = None
    bin: float | None = None
    empties_bin_after: float = 120.0
    turned: float = 0.0
    numbers: tuple[Setting, ...] = ()
    stages: tuple[tuple[str, str], ...] = ()
    code: Path | None = None

    def with_seed(self, seed: int) -> Trial:
        """Return the same with another seed."""
        return replace(self, seed=seed)
