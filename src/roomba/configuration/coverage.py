"""Numbers of planning how a floor is covered: the part ``coverage`` of ``mission.yaml``."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from roomba.configuration.frozen import (
    AtLeastOne,
    Count,
    Frozen,
    Length,
    NotNegative,
    Positive,
    Ratio,
)


class CoverageConfig(Frozen):
    """How a plan sweeps, in which order, and what it leaves; lengths in cells of ``cell`` m."""

    cell: Annotated[float, Field(ge=0.005, le=0.05)] = 0.01
    """m; approximate side of the cells on which floor is counted: finer is exacter, and slower."""
    out_of_station: Length = 0.4
    """m; the farthest from a robot in its station to where it can drive freely."""
    narrow: Positive = 6.0
    """Blocks of 5 cells to both sides; a place that is narrower divides the floor."""
    least_part: Count = 300
    """Blocks; a part with a smaller wide place is joined to its neighbour."""
    speck: Count = 20
    """Cells; smaller patches that the edges leave get no swath."""
    piece: Annotated[float, Field(ge=0.1, le=1000.0)] = 3.0
    """Widths of the tool; edges can be left for swaths about this often."""
    edge_worth: NotNegative = 1.0
    """Cells of new floor for a cell of way: the least that an edge is driven for."""
    edge_gap: Count = 4
    """Stretches of 10 cells; a gap without new floor that is no longer is driven along."""
    swath_cost: NotNegative = 30.0
    """Cells of way that getting to another swath costs, when the rows are chosen."""
    swath_gap: Count = 30
    """Cells; a swath goes on across swept floor that is narrower."""
    turning: NotNegative = 1.0
    """Cells of way that a radian costs in the order of edges and swaths."""
    polish_turning: NotNegative = 3.0
    """Cells of way that a radian costs when the way is polished."""
    unswept: Positive = 1.0
    """Cells of way that a cell of floor is worth when the way is polished."""
    spare: Ratio = 0.0015
    """Largest share of the floor that polishing may leave; bends may leave as much again."""
    bend_worth: NotNegative = 12.0
    """Cells of way that a sharp corner is worth: a bend in place of it costs no more."""
    bend_unswept: Positive = 10.0
    """Cells of way that a cell of floor is worth when corners become bends."""
    search_rounds: AtLeastOne = 5000
    """Exchanges after which the search for an order goes on only if they paid."""
    search_pays: Ratio = 0.005
    """Share of the cost that so many exchanges must gain, or the search ends."""
