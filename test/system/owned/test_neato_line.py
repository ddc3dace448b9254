"""How soon a Neato stands when its driver, or the driver's commander, is silent: in real time."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from fixtures.robots.neato_rig import NeatoRig
from fixtures.waiting import wait_until

from roomba.geometry import Twist

PROMISE = 0.5
"""s; so long after the last command the robot stands."""


@pytest.fixture(params=[None, 115_200], ids=["usb", "serial"])
def rig(request: pytest.FixtureRequest) -> Iterator[NeatoRig]:
    made = NeatoRig(request.param)
    yield made
    made.close()


def test_it_stands_when_nothing_more_is_wanted_of_it(rig: NeatoRig) -> None:
    rig.drive_until(Twist(0.1, 0.0), lambda: rig.moves, "it drives")
    silent = rig.simulator.time
    wait_until(lambda: not rig.moves, 5.0, "it stands")
    # The looks and the steps of the world are up to 0.05 s apart, but for rounding.
    assert rig.simulator.time - silent <= PROMISE + 0.05 + 1e-9


def test_it_stands_when_its_driver_hangs(rig: NeatoRig) -> None:
    rig.drive_until(Twist(0.1, 0.0), lambda: rig.moves, "it drives")
    rig.stop_serving()
    silent = rig.simulator.time
    wait_until(lambda: not rig.moves, 5.0, "it stands")
    assert rig.simulator.time - silent <= PROMISE + 0.05 + 1e-9
