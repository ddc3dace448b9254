"""Plans over HTTP, over a household whose time is set by hand."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.configuration.household import HouseholdConfig
from roomba.household.household import LiveHousehold
from roomba.ui.state_words import lines_of
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard

AUTHORISED = {"Authorization": "Bearer token"}
KITCHEN = {
    "mode": "rooms",
    "rooms": ["kitchen"],
    "passes": 2,
    "fan": "quiet",
    "carpets": "boost",
    "edges": "any",
    "only_due": False,
}
PLAN: dict[str, Any] = {
    "name": "kitchen",
    "rule": "FREQ=WEEKLY;BYDAY=MO,TH",
    "at": ["09:30"],
    "order": KITCHEN,
}


class Served:
    """The API of a household, and its clock."""

    def __init__(self, folder: Path) -> None:
        self.robot = WrittenRobot()
        self.robot.view = replace(
            VIEW, vacuum=replace(VIEW.vacuum, state="docked", phase="docked", battery=0.9)
        )
        self.now = dt.datetime(2026, 3, 2, 8, 0, tzinfo=dt.timezone.utc)
        self.household = LiveHousehold(
            self.robot,
            folder,
            HouseholdConfig(),
            100.0,
            lambda text: pytest.fail(text),
            now=lambda: self.now,
        )
        self.household.set_zone("UTC")
        app = create_app(self.robot, Guard("token"), household=self.household)
        self.client = TestClient(app, base_url="http://127.0.0.1", headers=AUTHORISED)

    def look(self, time: str) -> None:
        self.now = dt.datetime.fromisoformat(f"2026-{time}+00:00")
        self.household.look()

    def get(self, path: str) -> Any:
        return self.client.get(f"/api/v1/{path}").json()

    def ask(self, method: str, path: str, body: object = None) -> int:
        status: int = self.client.request(method, f"/api/v1/{path}", json=body or {}).status_code
        return status


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    served = Served(tmp_path)
    with served.client:
        yield served


def test_a_plan_is_put_told_carried_out_and_removed(served: Served) -> None:
    assert served.ask("PUT", "plans", PLAN) == 200
    (plan,) = served.get("plans")["plans"]
    assert plan["next"] == "2026-03-02T09:30:00+00:00"
    assert (plan["order"], plan["at"]) == (KITCHEN, ["09:30:00"])
    assert served.ask("PUT", "household/presence", {"at_home": True}) == 200
    served.look("03-02 09:30")
    state = served.get("state")["plans"]
    assert state["waiting"] == [
        {
            "plan": "kitchen",
            "due": "2026-03-02T09:30:00+00:00",
            "reason": "a person is at home",
        }
    ]
    assert state["next_at"] == "2026-03-05T09:30:00+00:00"
    told = lines_of(served.get("state"))
    assert ("plan", "kitchen: was due Mon 02 Mar 09:30, waits: a person is at home") in told
    assert ("next", "kitchen, Thu 05 Mar 09:30") in told
    assert served.robot.told == []
    assert served.ask("PUT", "household/waits", {"wanted": False}) == 200
    served.look("03-02 09:31")
    assert [name for name, _ in served.robot.told] == ["clean"]
    assert served.get("state")["plans"]["running"] == "kitchen"
    assert ("plan", "kitchen: under way") in lines_of(served.get("state"))
    assert served.get("plans")["notes"][0]["text"] == "began"
    assert served.ask("DELETE", "plans/kitchen") == 200
    assert served.ask("DELETE", "plans/kitchen") == 409
    assert served.get("plans")["plans"] == []


def test_quiet_hours_presets_and_the_zone_are_set(served: Served) -> None:
    quiet = {"begins": "22:00", "ends": "07:00", "days": [0, 6]}
    assert served.ask("PUT", "household/quiet", {"quiet": [quiet]}) == 200
    assert served.ask("PUT", "household/zone", {"zone": "europe/BERLIN"}) == 200
    assert served.ask("PUT", "household/zone", {"zone": "Atlantis"}) == 409
    assert served.ask("PUT", "presets", {"name": "quick", "order": KITCHEN}) == 200
    assert served.ask("POST", "presets/quick/begin") == 200
    assert served.robot.told[-1][0] == "clean"
    told = served.get("plans")
    assert told["quiet"] == [{"begins": "22:00:00", "ends": "07:00:00", "days": [0, 6]}]
    assert told["zone"] == "Europe/Berlin"
    assert told["presets"] == [{"name": "quick", "order": KITCHEN}]
    assert served.ask("DELETE", "presets/quick") == 200
    assert served.ask("POST", "presets/quick/begin") == 409


@pytest.mark.parametrize(("kind", "body"), [("plans", PLAN), ("presets", {"name": "kitchen"})])
def test_one_that_is_new_replaces_none(served: Served, kind: str, body: dict[str, Any]) -> None:
    def add() -> Any:
        headers = {"If-None-Match": "*"}
        return served.client.put(f"/api/v1/{kind}", json=body, headers=headers)

    assert add().status_code == 200
    refused = add()
    assert refused.status_code == 409
    assert f"expected a name that none of the {kind} has" in refused.json()["detail"]
    assert served.ask("PUT", kind, body) == 200
    assert len(served.get("plans")[kind]) == 1


def test_what_has_a_slash_in_its_name_is_begun_and_removed(served: Served) -> None:
    for name in ("up/down", "x/begin"):
        path = quote(name, safe="")
        assert served.ask("PUT", "plans", {**PLAN, "name": name}) == 200
        assert served.ask("PUT", "presets", {"name": name, "order": KITCHEN}) == 200
        assert served.ask("POST", f"presets/{path}/begin") == 200
        assert served.robot.told.pop()[0] == "clean"
        assert served.ask("DELETE", f"plans/{path}") == 200
        assert served.ask("DELETE", f"presets/{path}") == 200
    told = served.get("plans")
    assert (told["plans"], told["presets"]) == ([], [])


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"rule": "FREQ=HOURLY"}, "expected FREQ to be one of DAILY"),
        ({"rule": "FREQ=WEEKLY;BYDAY="}, "expected a day of the week at least, got none"),
        ({"at": ["9"]}, "expected a time of the clock on the wall such as 09:30, got '9'"),
        ({"at": ["09:30+01:00"]}, "expected a time of the clock on the wall such as 09:30"),
        ({"at": []}, "expected a time at least, got none"),
        ({"name": ""}, "expected a name of 1 to 80 printable characters, got ''"),
        ({"order": {"mode": "rooms"}}, "expected a room at least, got none"),
        ({"order": {"rooms": ["hall"]}}, "expected rooms for the mode rooms alone"),
        ({"colour": "red"}, "colour: expected no field of that name, got 'red'"),
    ],
)
def test_a_plan_that_makes_no_sense_is_refused(
    served: Served, wrong: dict[str, Any], said: str
) -> None:
    answer = served.client.put("/api/v1/plans", json={**PLAN, **wrong})
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith(said)
    assert served.get("plans")["plans"] == []


def test_without_the_token_plans_are_told_and_not_changed(served: Served) -> None:
    served.client.headers.pop("Authorization")
    assert served.ask("PUT", "plans", PLAN) == 401
    assert served.ask("PUT", "household/presence", {"at_home": True}) == 401
    assert served.get("plans")["plans"] == []


def test_each_request_with_a_body_has_an_example_that_is_taken(served: Served) -> None:
    paths = served.client.get("/openapi.json").json()["paths"]
    tried = 0
    for path, methods in paths.items():
        name = path.removeprefix("/api/v1/")
        if not name.startswith(("plans", "presets", "upkeep", "household")):
            continue
        for method, operation in methods.items():
            if "requestBody" in operation:
                body = operation["requestBody"]["content"]["application/json"]["example"]
                assert served.ask(method.upper(), name, body) == 200, path
                tried += 1
    assert tried == 8
