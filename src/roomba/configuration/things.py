"""Numbers of what the lidar sees beside the map: ``configuration/things.yaml``."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from roomba.configuration.frozen import Frozen, Length, NotNegative, Positive, Ratio

Count = Annotated[int, Field(ge=1, le=1000)]


class ThingConfig(Frozen):
    """What is a thing and what is not; m, and evidence, of which a scan gives ``gain`` to a cell.

    ``map_error``, ``margin_share``
        A beam that ends nearer to a surface of the map saw that surface: the map may be off by
        ``map_error`` of its cells, and an edge or the heading (0.7 degrees) by ``margin_share`` of
        the range. The deviation of the place and noise of the range come beside that.
    ``sure``
        A range is wrong by no more than so many times the standard deviation of its noise, which is
        measured from the scans.
    ``farthest``
        What is farther away is looked at when it is nearer: there beams are a cell apart.
    ``clearly``
        How much farther than a cell a beam has to go to have passed it.
    ``gain``, ``most_gain``
        What a scan in which a beam ends in a cell adds to it. One that stands for several scans
        adds as many times as much, up to ``most_gain``, so that one alone is never enough.
    ``behind``
        What a scan takes from a cell if more beams end just behind it than in it, or pass it
        closely: they met what is behind, and noise alone made some shorter.
    ``loss``
        What a scan that passes through the cell takes: more than ``gain``, for people walk on.
    ``most``
        The most evidence of a cell: once seen through, it is gone within ``most / loss`` scans.
    ``enough``
        Evidence with which a cell is a thing.
    ``spot_radius``
        A thing's cell counts as a disc of this size around where the beams end in it: as thick as a
        leg of a chair, and those of neighbouring cells leave no gap for any body.
    ``newest``
        Share of each new beam in the place where beams end.
    ``next_to``
        A point as near to a surface of the map as this is mapped: about a cell.
    """

    map_error: Positive = 0.5
    margin_share: NotNegative = 0.012
    sure: Positive = 3.0
    farthest: Length = 4.0
    clearly: Length = 0.10
    gain: Count = 2
    most_gain: Count = 4
    behind: Count = 1
    loss: Count = 3
    most: Count = 24
    enough: Count = 6
    spot_radius: Length = 0.02
    newest: Ratio = 0.2
    next_to: Length = 0.04
