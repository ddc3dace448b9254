"""Other people's programs, by the bytes that they send: each gets answers that it can read.

``neatoserial.py`` of jeroenterheerdt/neato-serial, and ``neato_driver.py`` of
mikeferguson/neato_robot. Tried by hand: the first as it is, the other, of Python 2, with its text
made bytes.
"""

from __future__ import annotations

import time

import pytest
from fixtures.robots.neato_rig import neato_world
from fixtures.waiting import wait_until

from roomba.emulators.neato.cleaning import OwnState
from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.robot import NeatoRobot
from roomba.emulators.neato.server import NeatoServer

DEADLINE = 20.0
"""s of wall time."""


class Wire:
    """Both ends of a line: what a program sent, and what the robot said."""

    def __init__(self) -> None:
        self._sent, self.said = b"", b""

    def read(self, seconds: float) -> bytes:
        sent, self._sent = self._sent, b""
        if not sent:
            time.sleep(min(seconds, 0.005))
        return sent

    def write(self, data: bytes) -> None:
        self.said += data

    def ask(self, sent: bytes, answers: int = 1) -> str:
        """Send bytes as a program does; return what came up to the end of so many answers."""
        self.said = b""
        self._sent += sent
        wait_until(lambda: self.said.count(b"\x1a") == answers, DEADLINE, f"an answer to {sent!r}")
        return self.said.decode()


def by_comma(answer: str) -> dict[str, str]:
    """The first two cells of each line, as both programs take them."""
    rows = [line.split(",") for line in answer.splitlines()]
    return {row[0]: row[1] for row in rows if len(row) > 1}


def serial_asks(wire: Wire, command: str) -> str:
    """Ask as neato-serial does, which wakes the robot with a word that is no command."""
    return wire.ask(b"wake-up\n" + command.encode() + b"\n", answers=2)


@pytest.mark.parametrize("model", Model)
def test_neato_serial_reads_all_that_it_asks_for(model: Model) -> None:
    wire = Wire()
    with NeatoServer(NeatoRobot(neato_world(), model), wire):
        assert by_comma(serial_asks(wire, "GetVersion"))["Serial Number"] == "EMULATED"
        assert float(by_comma(serial_asks(wire, "GetAccel"))["ZInG"]) > 0.9
        assert by_comma(serial_asks(wire, "GetButtons"))["BTN_START"] == "0"
        assert by_comma(serial_asks(wire, "GetCalInfo"))["LDSOffset"] == "0"
        charger = by_comma(serial_asks(wire, "GetCharger"))
        assert (charger["FuelPercent"], charger["ExtPwrPresent"]) == ("100", "1")
        assert int(charger["ChargingActive"]) == 0
        assert by_comma(serial_asks(wire, "GetDigitalSensors"))["SNSR_DUSTBIN_IS_IN"] == "1"
        # It takes an error to be one where the answer has three parts: echo, error, end.
        assert len(serial_asks(wire, "GetErr").split("\x1a", 1)[1].split("\r\n")) != 3
        assert len(by_comma(serial_asks(wire, "GetLDSScan"))) == 362


def test_neato_serial_reads_the_version_of_an_older_one() -> None:
    wire = Wire()
    with NeatoServer(NeatoRobot(neato_world(), Model.XV11), wire):
        assert by_comma(serial_asks(wire, "GetVersion"))["MainBoard Software"] == "23179"


@pytest.mark.parametrize("model", Model)
@pytest.mark.parametrize("command", ["Clean", "Clean House", "Clean Spot"])
def test_neato_serial_cleans_and_sees_it_by_the_fan(model: Model, command: str) -> None:
    wire = Wire()
    with NeatoServer(NeatoRobot(neato_world(), model), wire) as robot:
        serial_asks(wire, command)
        assert int(by_comma(serial_asks(wire, "GetMotors"))["Vacuum_RPM"]) > 0
        wait_until(
            lambda: by_comma(serial_asks(wire, "GetCharger"))["ExtPwrPresent"] == "0",
            DEADLINE,
            "it leaves its station",
        )
        serial_asks(wire, "Clean Stop")
        assert int(by_comma(serial_asks(wire, "GetMotors"))["Vacuum_RPM"]) == 0
        serial_asks(wire, "Clean Stop")
        assert robot.cleaning.phase is OwnState.STANDBY


def test_neato_driver_drives_reads_and_leaves() -> None:
    wire = Wire()
    with NeatoServer(NeatoRobot(neato_world(), Model.XV11), wire) as robot:
        wire.ask(b"testmode on\nsetldsrotation on\n", answers=2)
        assert robot.is_turning

        def values(command: bytes, heading: str, count: int) -> dict[str, int]:
            """So many lines after a heading, each a whole number by its label."""
            lines = wire.ask(command).splitlines()
            first = next(i for i, line in enumerate(lines) if line.split(",")[0] == heading) + 1
            rows = [line.split(",") for line in lines[first : first + count]]
            return {row[0]: int(row[1]) for row in rows if row[1].lstrip("-").isdigit()}

        assert len(values(b"getanalogsensors\n", "SensorName", 16)) == 16
        assert len(values(b"getdigitalsensors\n", "Digital Sensor Name", 8)) == 8
        assert values(b"getcharger\n", "Label", 17)["FuelPercent"] == 100
        assert len(values(b"getmotors\n", "Parameter", 30)) == 30
        scan = wire.ask(b"getldsscan\n").splitlines()
        assert scan[1].split(",")[0] == "AngleInDegrees"
        assert [int(line.split(",")[0]) for line in scan[2:362]] == list(range(360))
        wire.ask(b"setmotor 100 100 100\n")
        wait_until(
            lambda: values(b"getmotors\n", "Parameter", 30)["LeftWheel_PositionInMM"] > 90,
            DEADLINE,
            "it drives",
        )
        # It stops by a way of 1 mm, and of 0 then.
        wire.ask(b"setmotor 1 1 1\nsetmotor 0 0 0\n", answers=2)
        wire.ask(b"setldsrotation off\ntestmode off\n", answers=2)
        assert not robot.is_testing
