"""The connection to a real broker: password, TLS, floods; and to servers that hang, or are none."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fixtures.mosquitto import PASSWORD, USER, HomeSide, Mosquitto
from fixtures.waiting import unchanged, wait_until
from pydantic import SecretStr

from roomba.ui.smart_home.broker import (
    LONGEST_COMMAND,
    MOST_RATE,
    MOST_WAITING,
    Broker,
    BrokerError,
)
from roomba.ui.smart_home.settings import MqttConfig, TlsConfig
from roomba.ui.smart_home.topics import MqttTopics

TOPICS = MqttTopics("roomba/test", "homeassistant")


def linked(port: int, told: list[str], **more: Any) -> Broker:
    config = MqttConfig(host="127.0.0.1", port=port, **more)
    link = Broker(config, TOPICS, lambda: None, told.append, keep_alive=2)
    link.start()
    return link


@pytest.fixture(scope="module")
def broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mosquitto]:
    made = Mosquitto(tmp_path_factory.mktemp("broker"))
    made.start()
    yield made
    made.kill()


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mosquitto]:
    made = Mosquitto(tmp_path_factory.mktemp("guarded"), is_guarded=True, has_tls=True)
    made.start()
    yield made
    made.kill()


@pytest.fixture
def home(broker: Mosquitto) -> Iterator[HomeSide]:
    side = HomeSide(broker)
    yield side
    side.end()


def test_it_holds_the_newest_of_each_topic(broker: Mosquitto, home: HomeSide) -> None:
    link = linked(broker.port, [])
    for number in range(300):
        link.hold("roomba/test/state", str(number))
    wait_until(lambda: home.text("roomba/test/state") == "299", 10.0)
    link.stop()
    wait_until(lambda: home.text(TOPICS.available) == "offline", 10.0)
    assert home.count["roomba/test/state"] < 50


def test_commands_come_and_those_of_before_do_not(broker: Mosquitto, home: HomeSide) -> None:
    home.say(TOPICS.command, "start", retain=True)
    link = linked(broker.port, [])
    wait_until(lambda: link.is_connected, 10.0)
    wait_until(lambda: link.dropped == 1, 10.0)
    home.say(TOPICS.command, "pause")
    assert link.commands.get(timeout=10.0) == (TOPICS.command, "pause")
    assert link.commands.empty()
    link.stop()
    home.say(TOPICS.command, "", retain=True)


def test_a_last_will_that_comes_late_is_corrected(broker: Mosquitto, home: HomeSide) -> None:
    link = linked(broker.port, [])
    link.hold(TOPICS.available, "online")
    wait_until(lambda: home.text(TOPICS.available) == "online", 10.0)
    before = home.count[TOPICS.available]
    home.say(TOPICS.available, "offline", retain=True)
    wait_until(lambda: home.count[TOPICS.available] == before + 2, 10.0, lambda: str(home.count))
    assert home.text(TOPICS.available) == "online"
    link.stop()
    wait_until(lambda: home.text(TOPICS.available) == "offline", 10.0)


def test_of_two_programs_with_one_name_the_one_that_stays_is_told(
    broker: Mosquitto, home: HomeSide
) -> None:
    old, new = linked(broker.port, []), linked(broker.port, [])
    for link in (old, new):
        link.hold(TOPICS.available, "online")
    wait_until(lambda: old.is_connected and new.is_connected, 10.0)
    wait_until(lambda: home.text(TOPICS.available) == "online", 10.0)
    old.stop()
    wait_until(lambda: home.text(TOPICS.available) == "online", 10.0)
    assert unchanged(lambda: home.text(TOPICS.available), 0.3)
    new.stop()


def test_password_and_tls(guarded: Mosquitto) -> None:
    told: list[str] = []
    secret = SecretStr(PASSWORD)
    tls = TlsConfig(ca=guarded.authority)
    link = linked(guarded.port, told, user=USER, password=secret, tls=tls)
    wait_until(lambda: link.is_connected, 10.0, lambda: str(told))
    link.stop()


@pytest.mark.parametrize(
    ("password", "has_authority", "expected"),
    [("wrong", True, "refuses"), (PASSWORD, False, "certificate")],
)
def test_a_wrong_password_or_authority_is_told_once(
    guarded: Mosquitto, password: str, has_authority: bool, expected: str
) -> None:
    told: list[str] = []
    tls = TlsConfig(ca=guarded.authority) if has_authority else True
    link = linked(guarded.port, told, user=USER, password=SecretStr(password), tls=tls)
    wait_until(lambda: told, 10.0)
    assert not link.is_connected
    link.stop()
    assert expected in told[0]
    assert all(PASSWORD not in text and "wrong" not in text for text in told)


def test_an_authority_that_cannot_be_read_is_refused_at_once(tmp_path: Path) -> None:
    tls = TlsConfig(ca=tmp_path / "missing.crt")
    with pytest.raises(BrokerError, match=r"mqtt\.tls\.ca"):
        Broker(MqttConfig(host="a", tls=tls), TOPICS, lambda: None, print)


def test_a_flood_waits_at_the_broker(broker: Mosquitto, home: HomeSide) -> None:
    link = linked(broker.port, [])
    wait_until(lambda: link.is_connected, 10.0)
    began = time.monotonic()
    home.flood(TOPICS.command, "pause", 5000)
    home.flood(TOPICS.command, "x" * (LONGEST_COMMAND + 100), 20)
    wait_until(lambda: link.commands.full() and link.dropped > 40, 10.0)
    taken = link.commands.qsize() + link.dropped
    assert link.commands.qsize() == MOST_WAITING
    assert taken < 40 + MOST_RATE * (time.monotonic() - began)
    link.hold("roomba/test/after", "the flood")
    wait_until(lambda: home.text("roomba/test/after") == "the flood", 10.0)
    assert link.is_connected
    link.stop()


PROGRAM = """
import sys, time
from roomba.ui.smart_home.broker import Broker
from roomba.ui.smart_home.settings import MqttConfig
from roomba.ui.smart_home.topics import MqttTopics
config = MqttConfig(host="127.0.0.1", port=int(sys.argv[1]))
link = Broker(config, MqttTopics("roomba/test", "homeassistant"), lambda: None, print)
link.hold("roomba/test/available", "online")
link.start()
time.sleep(60.0)
"""


def test_of_a_program_that_was_killed_the_broker_tells_itself(
    broker: Mosquitto, home: HomeSide
) -> None:
    program = subprocess.Popen([sys.executable, "-c", PROGRAM, str(broker.port)])
    wait_until(lambda: home.text(TOPICS.available) == "online", 20.0)
    program.kill()
    program.wait(10.0)
    wait_until(lambda: home.text(TOPICS.available) == "offline", 10.0)


class Hanging:
    """A listener that takes connections, says what it is told to, and reads nothing."""

    def __init__(self, words: bytes) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = self._server.getsockname()[1]
        self.taken: list[socket.socket] = []
        self._words = words
        threading.Thread(target=self._take, daemon=True).start()

    def _take(self) -> None:
        while True:
            try:
                connection = self._server.accept()[0]
                self.taken.append(connection)
                connection.sendall(self._words)
            except OSError:
                if self._server.fileno() < 0:
                    return

    def end(self) -> None:
        self._server.close()
        for connection in self.taken:
            connection.close()


CONNACK = bytes([0x20, 3, 0, 0, 0])


@pytest.mark.parametrize("words", [b"", CONNACK], ids=["silent", "takes the connection"])
def test_a_broker_that_hangs_costs_no_memory_and_no_time(words: bytes) -> None:
    hanging = Hanging(words)
    link = linked(hanging.port, [])
    wait_until(lambda: hanging.taken, 10.0)
    began = time.monotonic()
    content = b"m" * 500_000
    for number in range(400):
        link.hold("roomba/test/map", content + str(number).encode())
    assert time.monotonic() - began < 2.0
    began = time.monotonic()
    link.stop()
    assert time.monotonic() - began < 5.0
    hanging.end()


@pytest.mark.parametrize(
    "words",
    [
        b"HTTP/1.1 400 Bad Request\r\n\r\n",
        CONNACK + b"\x30\x02\xff\xff" * 9,
        b"\x20\xff\xff\xff\xff",
    ],
    ids=["http", "bad message", "bad length"],
)
def test_what_is_no_broker_is_left_and_tried_again(words: bytes) -> None:
    hanging = Hanging(words)
    link = linked(hanging.port, [])
    wait_until(lambda: len(hanging.taken) >= 2, 20.0)
    link.stop()
    hanging.end()


def test_a_broker_that_was_killed_is_found_again(tmp_path: Path) -> None:
    told: list[str] = []
    broker = Mosquitto(tmp_path)
    link = linked(broker.port, told)
    link.hold("roomba/test/state", "before there is a broker")
    wait_until(lambda: told, 10.0)
    broker.start()
    wait_until(lambda: link.connections == 1, 20.0)
    broker.kill()
    wait_until(lambda: not link.is_connected, 10.0)
    link.hold("roomba/test/state", "while it is away")
    broker.start()
    side = HomeSide(broker)
    wait_until(lambda: side.text("roomba/test/state") == "while it is away", 20.0)
    link.stop()
    side.end()
    broker.kill()
    assert unchanged(lambda: link.connections, 0.2)
