"""The commands that a made-up Neato of each age knows, and answers."""

from __future__ import annotations

import pytest
from fixtures.robots.neato_rig import neato_world

from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.grammars import GRAMMARS
from roomba.emulators.neato.robot import NeatoRobot

ASKED = (
    "GetAccel", "GetAnalogSensors", "GetButtons", "GetCalInfo", "GetCharger", "GetDigitalSensors",
    "GetErr", "GetLDSScan", "GetMotors", "GetVersion", "GetWarranty", "Clean",
)  # fmt: skip
"""What programs of others ask of robots of all ages."""


@pytest.mark.parametrize("model", Model)
def test_each_command_is_there_once_and_answered(model: Model) -> None:
    names = [grammar.name for grammar in GRAMMARS[model]]
    assert len(set(names)) == len(names)
    robot = NeatoRobot(neato_world(), model)
    for name in names:
        assert "Unknown" not in robot.answer(name)


@pytest.mark.parametrize("model", Model)
def test_what_programs_ask_of_all_is_known_to_all(model: Model) -> None:
    assert set(ASKED) <= {grammar.name for grammar in GRAMMARS[model]}
