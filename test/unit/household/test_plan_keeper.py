"""Plans, live over a robot that writes down what it is told: kept, changed, carried out."""

from __future__ import annotations

import datetime as dt
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fixtures.households.living_plans import LivingPlans
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.clean_request import CleanRequest
from roomba.client.protocol import (
    CleanReport,
    ErrandOutcome,
    RequestRefusedError,
    RobotUnavailableError,
)
from roomba.client.view import RobotView
from roomba.household.plan_changes import removed, replaced
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder, Preset
from roomba.vocabulary import CleanMode, FanLevel

DOCKED = replace(VIEW, vacuum=replace(VIEW.vacuum, state="docked", phase="docked"))
KITCHEN = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen",), passes=2, fan=FanLevel.QUIET)
AT_NINE = Plan(name="kitchen", order=KITCHEN, at=(dt.time(9, 0),))


class Living(LivingPlans):
    """Plans of a home with a robot that has no rooms."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, WrittenRobot())

    def look(self, view: RobotView | None, minutes: float = 0.0) -> None:
        self.now += dt.timedelta(minutes=minutes)
        self.keeper.look(view)

    def reason(self) -> str:
        (plan,) = self.keeper.view().plans
        return plan.reason

    def last_note(self) -> str:
        return self.keeper.view().notes[-1].text


@pytest.fixture
def living(tmp_path: Path) -> Living:
    living = Living(tmp_path)
    living.put(AT_NINE)
    living.look(DOCKED)
    return living


def ended(outcome: ErrandOutcome, message: str = "") -> RobotView:
    return replace(DOCKED, last=CleanReport(outcome, message, 5.0, 6.0, 1.0, 30.0, 60.0, 1.0))


def test_a_plan_tells_the_robot_what_to_clean(living: Living) -> None:
    told = living.keeper.view()
    assert (told.next, told.next_at) == ("kitchen", living.now.replace(hour=9))
    living.look(DOCKED, 60)
    order = CleanRequest(CleanMode.ROOMS, ("kitchen",), passes=2, fan=FanLevel.QUIET, in_order=True)
    assert living.robot.told == [("clean", (order,))]
    assert living.keeper.view().running == "kitchen"
    living.look(VIEW, 1)
    living.look(ended(ErrandOutcome.COMPLETED), 20)
    assert living.keeper.view().running == ""
    assert living.last_note() == "done: 5.0 of 6.0 m²"


@pytest.mark.parametrize(
    ("view", "said"),
    [
        (None, "the robot does not answer"),
        (replace(DOCKED, held="a cat"), "the emergency stop holds the drive"),
        (VIEW, "the robot is busy"),
        (
            replace(DOCKED, vacuum=replace(VIEW.vacuum, state="error", phase="error")),
            "the robot needs help",
        ),
        (replace(DOCKED, vacuum=replace(DOCKED.vacuum, battery=0.29)), "the battery is below 30 %"),
    ],
)
def test_it_says_why_nothing_begins(living: Living, view: RobotView | None, said: str) -> None:
    living.look(view, 60)
    assert living.robot.told == []
    assert living.reason() == said
    living.look(DOCKED, 5)
    assert [name for name, _ in living.robot.told] == ["clean"]
    assert math.isnan(DOCKED.vacuum.battery), "a battery that is not heard of is not judged"


def test_a_refusal_is_told(living: Living) -> None:
    living.robot.refusal = "there is no room kitchen"
    living.look(DOCKED, 60)
    assert living.reason() == "there is no room kitchen"
    assert living.keeper.view().running == ""


SILENCE = "expected the robot's answer within 5 s, got none"


def silent(living: Living) -> list[CleanRequest]:
    """Let the robot hear what it is to clean, and not answer; return what it hears from now on."""
    heard: list[CleanRequest] = []

    def clean(request: CleanRequest) -> None:
        heard.append(request)
        raise RobotUnavailableError(SILENCE)

    living.robot.__dict__["clean"] = clean
    return heard


def test_a_clean_that_began_without_an_answer_is_not_begun_again(living: Living) -> None:
    heard = silent(living)
    living.look(DOCKED, 60)
    living.look(DOCKED, 0.1)
    living.look(VIEW, 0.1)
    assert (living.keeper.view().running, living.last_note()) == ("kitchen", "began")
    living.look(VIEW, 40)
    living.look(ended(ErrandOutcome.COMPLETED), 1)
    living.look(DOCKED, 60)
    assert living.last_note() == "done: 5.0 of 6.0 m²"
    assert len(heard) == 1


def test_one_that_did_not_begin_is_tried_again_and_why_is_told(living: Living) -> None:
    heard = silent(living)
    living.look(DOCKED, 60)
    living.look(DOCKED, 0.1)
    living.look(DOCKED, 1)
    assert living.reason() == SILENCE
    assert [note.text for note in living.keeper.view().notes] == [f"tried again 09:31: {SILENCE}"]
    living.look(DOCKED, 31)
    assert len(heard) == 2


def test_the_emergency_stop_does_not_tell_that_a_clean_without_an_answer_began(
    living: Living,
) -> None:
    heard = silent(living)
    living.look(DOCKED, 60)
    living.look(replace(DOCKED, held="a cat"), 0.5)
    living.look(DOCKED, 0.1)
    living.look(DOCKED, 1)
    texts = [note.text for note in living.keeper.view().notes]
    assert texts == ["left to you: the emergency stop was pressed", f"ended: {SILENCE}"]
    living.look(DOCKED, 60)
    assert len(heard) == 1


def test_one_that_is_seen_to_work_before_the_emergency_stop_began(living: Living) -> None:
    silent(living)
    living.look(DOCKED, 60)
    living.look(VIEW, 0.1)
    living.look(replace(DOCKED, held="a cat"), 0.5)
    living.look(DOCKED, 0.1)
    living.look(DOCKED, 1)
    assert [note.text for note in living.keeper.view().notes] == [
        "began",
        "left to you: the emergency stop was pressed",
        "ended: the robot was switched off meanwhile",
    ]


def test_a_program_that_begins_anew_knows_what_was_under_way(living: Living) -> None:
    living.look(DOCKED, 60)
    living.again()
    assert living.keeper.view().running == "kitchen"
    # How an errand ended that the page still shows is no news.
    living.look(replace(VIEW, last=ended(ErrandOutcome.STOPPED).last), 1)
    assert living.keeper.view().running == "kitchen"
    living.look(ended(ErrandOutcome.STUCK, "the robot is stuck"), 1)
    assert living.reason() == "the robot is stuck"


def test_what_was_missed_meanwhile_is_tried_when_it_runs_again(living: Living) -> None:
    living.now += dt.timedelta(hours=10)
    living.again()
    living.look(DOCKED)
    assert [name for name, _ in living.robot.told] == ["clean"]
    assert living.keeper.view().notes[0].text.startswith("missed")


@pytest.mark.parametrize("fault", [OSError("not kept"), ZeroDivisionError("a fault")])
def test_plans_go_on_if_nothing_can_be_learned_of_dirt(
    living: Living, monkeypatch: pytest.MonkeyPatch, fault: Exception
) -> None:
    def fail(*_: object) -> None:
        raise fault

    living.look(DOCKED, 60)
    living.look(VIEW, 1)
    monkeypatch.setattr("roomba.household.dirt_keeper.learned", fail)
    last = ended(ErrandOutcome.COMPLETED)
    with pytest.raises(type(fault)):
        living.look(last, 20)
    assert (living.keeper.view().running, living.last_note()) == ("", "done: 5.0 of 6.0 m²")
    # What ended is no news any more.
    living.look(last, 23 * 60)
    living.look(last, 60)
    assert [name for name, _ in living.robot.told] == ["clean"] * 2


def test_a_robot_that_does_not_obey_is_told_of(living: Living) -> None:
    living.look(DOCKED, 60)
    living.keeper.change(lambda all_: all_.model_copy(update={"is_person_home": True}))
    living.robot.refusal = "it cannot pause now"
    living.look(VIEW, 1)
    assert living.last_note() == "the robot did not obey (pause): it cannot pause now"


def test_a_clean_during_which_the_emergency_stop_was_pressed_is_left_to_people(
    living: Living,
) -> None:
    living.look(DOCKED, 60)
    living.look(VIEW, 1)
    living.look(replace(VIEW, held="a cat"), 1)
    assert living.last_note() == "left to you: the emergency stop was pressed"
    living.keeper.change(lambda all_: all_.model_copy(update={"is_person_home": True}))
    living.look(VIEW, 1)
    assert [name for name, _ in living.robot.told] == ["clean"]


def test_a_plan_that_is_changed_makes_up_for_nothing(living: Living) -> None:
    living.look(VIEW, 60)
    assert living.reason() == "the robot is busy"
    living.put(AT_NINE.model_copy(update={"at": (dt.time(8, 30),)}))
    living.look(DOCKED, 1)
    assert living.robot.told == []
    assert living.keeper.view().next_at == dt.datetime(2026, 3, 3, 8, 30, tzinfo=dt.timezone.utc)


def test_what_another_program_changed_meanwhile_stays(living: Living) -> None:
    other = Living(living.folder)
    other.put(AT_NINE.model_copy(update={"name": "theirs"}))
    living.put(AT_NINE.model_copy(update={"name": "ours"}))
    living.again()
    assert [plan.name for plan in living.keeper.view().plans] == [AT_NINE.name, "theirs", "ours"]


@pytest.mark.parametrize(
    ("old", "new", "hour"),
    [("09:00", "08:30", 8), ('"zone": "UTC"', '"zone": "Atlantic/Azores"', 10)],
)
def test_plans_that_were_edited_by_hand_go_by_their_new_times(
    living: Living, old: str, new: str, hour: int
) -> None:
    file = living.folder / "plans.json"
    lines = file.read_text("utf-8").replace(old, new).splitlines()
    # As the message says to a person who edits what is sealed.
    file.write_text("\n".join(line for line in lines if "# kept" not in line), "utf-8")
    living.again()
    living.look(DOCKED)
    expected = living.keeper.view().next_at
    assert expected is not None
    assert (expected.day, expected.hour) == (living.now.day, hour)
    living.now = expected
    living.look(DOCKED)
    assert [name for name, _ in living.robot.told] == ["clean"]


def test_another_zone_moves_all_times(living: Living) -> None:
    living.keeper.change(lambda all_: all_.model_copy(update={"zone": "America/New_York"}))
    assert living.keeper.view().next_at == living.now.replace(hour=14)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"zone": "nowhere"}, "got 'nowhere'"),
        ({"plans": (AT_NINE, AT_NINE)}, "each name once"),
    ],
)
def test_what_makes_no_sense_changes_nothing(
    living: Living, wrong: dict[str, Any], said: str
) -> None:
    before = living.keeper.view()
    with pytest.raises(RequestRefusedError, match=said):
        living.keeper.change(lambda all_: all_.model_copy(update=wrong))
    assert living.keeper.view() == before


def test_presets_begin_by_their_name_and_what_there_is_not_is_said(living: Living) -> None:
    preset = Preset(name="quick", order=KITCHEN)
    living.keeper.change(lambda all_: replaced(all_, "presets", "quick", preset))
    living.keeper.begin("quick")
    assert [name for name, _ in living.robot.told] == ["clean"]
    with pytest.raises(RequestRefusedError, match="one of quick; got 'slow'"):
        living.keeper.begin("slow")
    with pytest.raises(RequestRefusedError, match="expected one of kitchen, got 'hall'"):
        living.keeper.change(lambda all_: removed(all_, "plans", "hall"))
    living.keeper.change(lambda all_: removed(all_, "plans", "kitchen"))
    assert living.keeper.view().plans == ()
    again = HouseholdPlans.model_validate(living.keeper.view().household.model_dump())
    assert [each.name for each in again.presets] == ["quick"]
