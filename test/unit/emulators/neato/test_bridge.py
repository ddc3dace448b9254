"""The made-up bridge of OpenNeato, as a program in the home network finds it."""

from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from fixtures.robots.neato_rig import neato_world

from roomba.emulators.neato.bridge import NeatoBridge
from roomba.emulators.neato.cleaning import OwnState
from roomba.emulators.neato.robot import NeatoRobot


@pytest.fixture(scope="module")
def bridge() -> Iterator[NeatoBridge]:
    with NeatoBridge(NeatoRobot(neato_world()), speed=5.0) as made:
        yield made


def ask(bridge: NeatoBridge, method: str, path: str) -> tuple[int, str]:
    connection = http.client.HTTPConnection(bridge.address, timeout=10.0)
    connection.request(method, path)
    response = connection.getresponse()
    return response.status, response.read().decode()


def told(bridge: NeatoBridge, what: str) -> Any:
    status, text = ask(bridge, "GET", f"/api/{what}")
    assert status == 200
    return json.loads(text)


def test_commands_are_handed_on_as_they_are(bridge: NeatoBridge) -> None:
    status, text = ask(bridge, "POST", "/api/serial?cmd=GetVersion")
    assert status == 200
    assert text.startswith("GetVersion\r\nComponent,Major,Minor,Build,Aux\r\n")
    assert "\x1a" not in text
    assert ask(bridge, "POST", "/api/serial?cmd=Fly%20High")[1].startswith("Fly High\r\n")


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("POST", "/api/serial", 400),
        ("POST", "/api/serial?cmd=", 400),
        ("POST", "/api/nothing", 404),
        ("GET", "/api/nothing", 404),
        ("GET", "/", 404),
    ],
)
def test_what_it_does_not_know_is_refused(
    bridge: NeatoBridge, method: str, path: str, status: int
) -> None:
    found, text = ask(bridge, method, path)
    assert found == status
    assert json.loads(text)["error"]


def test_it_tells_what_the_robot_tells_as_json(bridge: NeatoBridge) -> None:
    charger = told(bridge, "charger")
    assert charger["fuelPercent"] == 100.0
    assert charger["extPwrPresent"] is True
    assert told(bridge, "motors")["leftWheelPositionMM"] == 0.0
    assert told(bridge, "state")["uiState"].startswith("UIMGR_STATE_")
    ask(bridge, "POST", "/api/serial?cmd=TestMode%20On")
    ask(bridge, "POST", "/api/serial?cmd=SetLDSRotation%20On")
    scan = told(bridge, "lidar")
    assert [point["angle"] for point in scan["points"]] == list(range(360))
    assert scan["validPoints"] == sum(point["error"] == 0 for point in scan["points"]) > 200
    assert scan["rotationSpeed"] > 3.0


def test_it_asks_the_robot_at_most_once_a_second(bridge: NeatoBridge) -> None:
    first = told(bridge, "motors")
    bridge.robot.simulator.set_charge(0.5)
    before = told(bridge, "charger")
    assert told(bridge, "charger") == before
    assert told(bridge, "motors") == first


def test_it_begins_pauses_and_ends_the_robots_own_cleans(bridge: NeatoBridge) -> None:
    ask(bridge, "POST", "/api/serial?cmd=TestMode%20Off")

    def after(action: str) -> str:
        assert ask(bridge, "POST", f"/api/clean?action={action}")[0] == 200
        return str(told(bridge, "state")["uiState"]).removeprefix("UIMGR_STATE_")

    assert after("pause") == "STANDBY"
    assert after("house") == "HOUSECLEANINGRUNNING"
    assert after("pause") == "HOUSECLEANINGPAUSED"
    assert after("pause") == "HOUSECLEANINGPAUSED"
    assert after("house") == "HOUSECLEANINGRUNNING"
    assert after("stop") == "STANDBY"
    assert after("spot") == "SPOTCLEANINGRUNNING"
    assert after("stop") == "STANDBY"
    assert told(bridge, "error")["hasError"] is False
    assert ask(bridge, "POST", "/api/clean?action=dock")[0] == 503


def test_in_the_test_mode_it_begins_no_clean(bridge: NeatoBridge) -> None:
    ask(bridge, "POST", "/api/serial?cmd=TestMode%20On")
    for action in ("house", "spot"):
        ask(bridge, "POST", f"/api/clean?action={action}")
        assert bridge.robot.cleaning.phase is OwnState.STANDBY
    ask(bridge, "POST", "/api/serial?cmd=TestMode%20Off")
    ask(bridge, "POST", "/api/clean?action=house")
    assert bridge.robot.cleaning.phase is OwnState.HOUSE
    ask(bridge, "POST", "/api/clean?action=stop")


def test_a_state_that_was_asked_for_before_a_clean_is_not_kept_as_news(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with NeatoBridge(NeatoRobot(neato_world()), speed=5.0) as bridge:
        said, is_asked, may_answer = bridge.said, threading.Event(), threading.Event()

        def slowly(command: str) -> str | None:
            answer = said(command)
            is_asked.set()
            assert may_answer.wait(20.0)
            return answer

        monkeypatch.setattr(bridge, "said", slowly)
        looking = threading.Thread(target=lambda: bridge.told("state"))
        cleaning = threading.Thread(target=lambda: bridge.clean("house"))
        looking.start()
        assert is_asked.wait(20.0)
        cleaning.start()
        cleaning.join(0.5)  # without order it is done by then
        may_answer.set()
        looking.join(20.0)
        cleaning.join(20.0)
        now = bridge.told("state")
    assert now is not None
    assert now["uiState"] == "UIMGR_STATE_HOUSECLEANINGRUNNING"
