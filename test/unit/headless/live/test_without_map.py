"""What needs a map is refused by a robot that has none."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import ZoneView
from roomba.headless.live.without_map import WithoutMap


class Blind(WithoutMap):
    no_map = "it sees nothing"


ZONE = ZoneView("hall", "no-go", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)))


@pytest.mark.parametrize(
    "ask",
    [
        lambda robot: robot.change_rooms(("hall",)),
        lambda robot: robot.explore(),
        lambda robot: robot.put_zone(ZONE),
        lambda robot: robot.remove_zone("hall"),
        lambda robot: robot.rename_room("hall", "den"),
        lambda robot: robot.join_rooms(("hall", "den")),
        lambda robot: robot.split_room("hall", (0.0, 0.0), (1.0, 0.0)),
        lambda robot: robot.undo_rooms(),
    ],
)
def test_what_needs_a_map_is_refused_with_the_reason(ask: Callable[[Blind], None]) -> None:
    with pytest.raises(RequestRefusedError, match=r"^it sees nothing$"):
        ask(Blind())


def test_what_its_station_has_not_is_refused() -> None:
    with pytest.raises(RequestRefusedError, match="empties no bin"):
        Blind().empty_at_station()
    with pytest.raises(RequestRefusedError, match="has no bag"):
        Blind().replace_bag()
