"""The original's parameters: their names, spellings and limits."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

from pydantic import Field

from roomba.configuration.body import Speed
from roomba.configuration.frozen import Finite, Frozen, validated
from roomba.errors import ConfigError


class SeedParameters(Frozen):
    """The original's parameters (docs/ros_interface.md), validated; metres and m/s.

    Other spellings of the report (``initial_pos_x``, ``max_coordinate`` …) are accepted by
    :func:`parse_seed_parameters`.
    """

    robot_name: Annotated[str, Field(min_length=1, strict=True)] = "roomba_robot"
    robot_max_speed: Speed = 0.5
    initial_post_x: Finite = 0.0
    initial_post_y: Finite = 0.0
    initial_post_theta: Finite = 0.0
    min_cordinate: Finite = -100.0
    max_cordinate: Finite = 100.0

    in_order: ClassVar[tuple[str, ...]] = ("min_cordinate < max_cordinate",)

    def allows(self, x: float, y: float) -> bool:
        """Whether a point, m, is finite and within the limits of both coordinates."""
        return all(
            math.isfinite(value) and self.min_cordinate <= value <= self.max_cordinate
            for value in (x, y)
        )


SEED_SPELLINGS: dict[str, tuple[str, ...]] = {
    "robot_name": ("robot_name",),
    "robot_max_speed": ("robot_max_speed",),
    "initial_post_x": ("initial_post_x", "initial_pos_x"),
    "initial_post_y": ("initial_post_y", "initial_pos_y"),
    "initial_post_theta": ("initial_post_theta",),
    "min_cordinate": ("min_cordinate", "min_coordinate"),
    "max_cordinate": ("max_cordinate", "max_coordinate"),
}
"""Each parameter with the spellings that mean it, the first one its own."""


def parse_seed_parameters(values: dict[str, Any]) -> SeedParameters:
    """Return the validated parameters; what is missing has its default.

    ``values`` maps names, in any spelling of :data:`SEED_SPELLINGS`, to raw values. Another
    spelling counts before the parameter's own, which the launch file always sets.
    Raises :class:`ConfigError` with one line that names the parameter, its value and what is meant.
    """
    known: dict[str, Any] = {}
    for name, spellings in SEED_SPELLINGS.items():
        for spelling in spellings:
            if spelling in values:
                known[name] = values[spelling]
    for name, value in known.items():
        if name != "robot_name" and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise ConfigError(f"parameter {name}: expected a number, got {value!r}")
    return validated(SeedParameters, known, "parameter ")
