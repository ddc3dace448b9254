"""Where the robot looks for things that its map does not show."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, START, Eye

from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import PlacedScan, plain_ranges
from roomba.perception.matching.surface_field import SurfaceField
from roomba.robot.lookout import Lookout

KNOWN = 0.5 * CONFIG.localization.known_deviation
UNSURE = 2.0 * CONFIG.localization.known_deviation


def found_by(knowledge: Knowledge, unsure: float) -> int:
    """Return how many things it finds in a home of whose furniture its map shows nothing."""
    empty = FURNISHED.map.values.copy()
    empty[2:-2, 2:-2] = 0
    lookout = Lookout(CONFIG)
    shown = type(FURNISHED.map)(FURNISHED.map.frame, empty)
    things = lookout.look_beside(SurfaceField.of(shown))
    ranges = Eye(FURNISHED).scan(START)
    scan = PlacedScan(START, ranges, plain_ranges(ranges), LIDAR)
    for _ in range(20):
        lookout.look(scan, knowledge, unsure)
    return int(np.count_nonzero(things.cells(1)))


@pytest.mark.parametrize(
    ("knowledge", "unsure", "finds"),
    [
        (Knowledge.KNOWN, KNOWN, True),
        (Knowledge.ROUGH, KNOWN, True),
        (Knowledge.ROUGH, UNSURE, False),
        (Knowledge.SEARCHING, KNOWN, False),
    ],
    ids=["known", "known well, but the home changed", "unsure", "searched for"],
)
def test_it_looks_where_its_place_is_known_well(
    knowledge: Knowledge, unsure: float, finds: bool
) -> None:
    assert (found_by(knowledge, unsure) > 0) == finds
