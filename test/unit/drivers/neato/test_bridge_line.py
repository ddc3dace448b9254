"""A Neato's line through OpenNeato's bridge: whole answers, late ones, and what is no bridge."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Iterator

import pytest
from fixtures.robots.neato_rig import NEATO, neato_world
from fixtures.waiting import wait_until

from roomba.configuration.robot import load_robot_config
from roomba.drivers.line import LineError
from roomba.drivers.neato.body import NeatoBody
from roomba.drivers.neato.bridge_line import PATIENCE, PER_BYTE, BridgeLine
from roomba.drivers.neato.conversation import Conversation, SilenceError
from roomba.emulators.neato.bridge import NeatoBridge
from roomba.emulators.neato.robot import NeatoRobot
from roomba.geometry import Twist
from roomba.robot.command import Command

WITHIN = 5.0
"""s of wall time."""


@pytest.fixture
def bridge() -> Iterator[NeatoBridge]:
    with NeatoBridge(NeatoRobot(neato_world())) as made:
        yield made


@pytest.fixture
def said() -> Iterator[tuple[str, list[bytes]]]:
    """A program that answers each connection with the next of some bytes, and where it is."""
    answers: list[bytes] = []
    listening = socket.create_server(("127.0.0.1", 0))

    def serve() -> None:
        while True:
            try:
                connection, _ = listening.accept()
            except OSError:
                return
            with contextlib.suppress(OSError):  # the driver may have given up already
                connection.recv(4096)
                if answers:
                    connection.sendall(answers.pop(0))
                    connection.close()

    threading.Thread(target=serve, daemon=True).start()
    yield f"127.0.0.1:{listening.getsockname()[1]}", answers
    listening.close()


def answer(status: str, body: bytes) -> bytes:
    return b"HTTP/1.1 %s\r\nContent-Length: %d\r\n\r\n%s" % (status.encode(), len(body), body)


def test_whole_answers_come_with_their_echo(bridge: NeatoBridge) -> None:
    talk = Conversation(BridgeLine(bridge.address), time.monotonic)
    assert talk.ask("GetVersion", WITHIN)[0].startswith("Component")
    assert talk.ask("TestMode On", WITHIN) == []
    assert bridge.robot.is_testing
    talk.ask("SetLDSRotation On", WITHIN)
    assert len(talk.ask("GetLDSScan", WITHIN)) == 362
    talk.close()


def test_a_scan_began_to_come_before_the_bridge_sent_it(bridge: NeatoBridge) -> None:
    talk = Conversation(BridgeLine(bridge.address), time.monotonic, PATIENCE, PER_BYTE)
    before = time.monotonic()
    talk.ask("GetLDSScan", WITHIN)
    since_heard = talk.since_heard  # both go on: this one is to be read first
    took = time.monotonic() - before
    assert 0.2 < since_heard < took


def test_a_late_answer_is_no_answer_to_another_question(bridge: NeatoBridge) -> None:
    talk = Conversation(BridgeLine(bridge.address), time.monotonic)
    with pytest.raises(SilenceError):
        talk.ask("GetLDSScan", 0.05)
    assert talk.ask("GetTime", WITHIN) == ["Sunday 0:00:00"]


def test_a_busy_bridge_is_a_silent_robot(said: tuple[str, list[bytes]]) -> None:
    address, answers = said
    talk = Conversation(BridgeLine(address), time.monotonic)
    answers.append(answer("503 Busy", b'{"error":"unavailable"}'))
    with pytest.raises(SilenceError):
        talk.ask("GetTime", 0.2)
    answers.append(answer("200 OK", b"GetTime\r\nSunday 0:00:00\r\n"))
    assert talk.ask("GetTime", WITHIN) == ["Sunday 0:00:00"]


@pytest.mark.parametrize(
    ("bytes_", "reason"),
    [
        (answer("404 Not Found", b""), "got status 404 of /api/serial"),
        (b"SSH-2.0-OpenSSH\r\n", "expected OpenNeato's bridge at"),
        (b"", "Is the robot switched on"),
    ],
)
def test_another_program_is_named(
    said: tuple[str, list[bytes]], bytes_: bytes, reason: str
) -> None:
    address, answers = said
    answers.append(bytes_)
    with pytest.raises(LineError, match=reason):
        Conversation(BridgeLine(address), time.monotonic).ask("GetTime", WITHIN)


def test_an_address_where_nothing_is_is_told_with_what_helps() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(LineError, match="switched on, and in this network"):
        BridgeLine(f"127.0.0.1:{port}").write(b"GetTime\n")


@pytest.mark.parametrize("address", ["", "/dev/ttyACM0", "http://neato.local", "neato:x", "a@b"])
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(LineError, match=r"such as neato\.local"):
        BridgeLine(address)


def test_the_driver_drives_through_it(bridge: NeatoBridge) -> None:
    talk = Conversation(BridgeLine(bridge.address), time.monotonic, PATIENCE, PER_BYTE)
    body = NeatoBody(talk, time.monotonic, load_robot_config(NEATO))
    body.begin()

    def leaves() -> bool:
        body.act(Command(Twist(0.2, 0.0)))
        body.serve()
        return body.read().odometry.x > 0.3

    def scans() -> bool:
        body.serve()
        return body.newest_scan() is not None

    wait_until(leaves, 20.0, "it leaves its station")
    true, station = bridge.robot.simulator.pose, bridge.robot.simulator.home.station
    assert true.distance_to(station.x, station.y) == pytest.approx(0.3, abs=0.1)
    wait_until(scans, 20.0, "a scan")
    body.end()
    assert not bridge.robot.is_testing
