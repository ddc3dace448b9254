"""The stages of planning coverage as functions, each of which a program may replace by its own.

Places are in cells of the window, (x, y) as (column, row); whole numbers are the cells' centres.
The docstrings of the default stages say what each stage takes and returns.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Final, ParamSpec, TypeVar

from roomba.arrays import Floats, Mask, Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.passes.edges import edges as our_edges
from roomba.planning.coverage.passes.swaths import swaths as our_swaths
from roomba.planning.coverage.tour.connection import connected as our_connection
from roomba.planning.coverage.tour.net import Net
from roomba.planning.coverage.tour.order import ordered as our_order
from roomba.planning.coverage.tour.polish import polished as our_polish
from roomba.planning.coverage.tour.rounding import rounded as our_rounding

_Given = ParamSpec("_Given")
_Made = TypeVar("_Made")

Edges = Callable[[list[Polyline], Mask, Mask, float, float, CoverageConfig], list[Polyline]]
"""rings, need, middles, radius, length of a piece, configuration: lines along walls."""
Swaths = Callable[[Mask, Mask, float, CoverageConfig], list[Polyline]]
"""left, middles, radius, configuration: straight lines that sweep what is left."""
Order = Callable[[Net, list[Polyline], Floats, Floats | None, CoverageConfig], list[Polyline]]
"""net, lines, first place, last place, configuration: all lines in order and direction."""
Connection = Callable[[Net, list[Polyline], Floats, Floats | None], Polyline]
"""net, lines in order, first place, last place: one line."""
Polish = Callable[[Polyline, Mask, Mask, float, CoverageConfig], Polyline]
"""line, need, middles, radius, configuration: a shorter and straighter line."""
Rounding = Callable[[Polyline, Mask, Mask, float, float, CoverageConfig], Polyline]
"""line, need, middles, radius, sharp corner in rad, configuration: a line with bends in place of
sharp corners."""


@dataclass(frozen=True, slots=True)
class CoverageStages:
    """The stages in the order in which they are called, each with its default."""

    edges: Edges = our_edges
    swaths: Swaths = our_swaths
    order: Order = our_order
    connection: Connection = our_connection
    polish: Polish = our_polish
    rounding: Rounding = our_rounding

    def telling(self, tell: Callable[[], None]) -> CoverageStages:
        """Return the same stages, each of which calls ``tell`` first: a large plan takes long."""
        told = {field.name: _telling(getattr(self, field.name), tell) for field in fields(self)}
        return CoverageStages(**told)


def _telling(stage: Callable[_Given, _Made], tell: Callable[[], None]) -> Callable[_Given, _Made]:
    def told(*given: _Given.args, **named: _Given.kwargs) -> _Made:
        tell()
        return stage(*given, **named)

    return told


OUR_STAGES: Final = CoverageStages()
