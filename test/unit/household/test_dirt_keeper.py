"""What is learned of the rooms' dirt is kept, and plans go by it."""

from __future__ import annotations

import datetime as dt
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.households.living_plans import LivingPlans
from fixtures.households.written_robot import HOME, VIEW, WrittenRobot

from roomba.clean_request import CleanRequest
from roomba.client.household import plans_of
from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.view import HomeView, RobotView, RoomView
from roomba.configuration.frozen import Frozen
from roomba.household.folder import KeptValues
from roomba.household.plan_changes import replaced
from roomba.plans.due import DirtRecords
from roomba.plans.plan import Plan, PlannedOrder
from roomba.vocabulary import CleanMode, RoomDirt

DOCKED = replace(VIEW, vacuum=replace(VIEW.vacuum, state="docked", phase="docked"))
DUE = Plan(name="daily", order=PlannedOrder(only_due=True), at=(dt.time(9, 0),))
ROOMS = tuple(
    RoomView(name, 4.0, (x, 0.0), (((x, 0.0), (x + 1.0, 0.0), (x, 4.0), (x, 0.0)),))
    for x, name in enumerate(("kitchen", "den"))
)


class RoomyRobot(WrittenRobot):
    rooms = ROOMS

    def home(self) -> HomeView:
        return replace(HOME, rooms=self.rooms)


class Living(LivingPlans):
    """A keeper of plans over a robot with two rooms."""

    robot: RoomyRobot

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, RoomyRobot())
        self.put(DUE)
        self.keeper.look(DOCKED)

    def day(self, view: RobotView = DOCKED, **grains: float) -> list[CleanRequest]:
        """Let a day pass, at nine of which the plan is due; return what is begun.

        What is begun ends an hour later, and finds such dirt.
        """
        self.now = self.now.replace(hour=9, minute=1)
        self.robot.told.clear()
        self.keeper.look(view)
        begun = [arguments[0] for name, arguments in self.robot.told if name == "clean"]
        self.keeper.look(VIEW)
        self.now += dt.timedelta(hours=1)
        rooms = tuple(RoomDirt(name, 1.0, value) for name, value in grains.items())
        report = CleanReport(
            ErrandOutcome.COMPLETED, "", 8.0, 8.0, 1.0, 30.0, 60.0, 1.0, rooms=rooms
        )
        self.last = replace(DOCKED, last=report) if begun else DOCKED
        self.keeper.look(self.last)
        self.now = self.now.replace(hour=8) + dt.timedelta(days=1)
        self.keeper.look(DOCKED)
        return begun


def test_a_plan_cleans_what_is_due_and_says_why(tmp_path: Path) -> None:
    living = Living(tmp_path)
    both = CleanRequest(CleanMode.ROOMS, ("kitchen", "den"))
    assert living.day(kitchen=5000.0, den=5000.0) == [both]
    assert living.day(kitchen=1000.0, den=450.0) == [both]
    living.again()
    living.keeper.look(DOCKED)
    assert living.day(kitchen=1000.0) == [CleanRequest(CleanMode.ROOMS, ("kitchen",))]
    needs = plans_of(living.keeper.view())["needs"]
    assert [need["every"] for need in needs] == [1, 2]
    assert needs[1]["reason"] == "it becomes 0.45 times as dirty as kitchen"
    assert living.day(kitchen=1000.0, den=900.0) == [both]


def test_what_is_learned_goes_on_by_the_name_of_a_room_now(tmp_path: Path) -> None:
    living = Living(tmp_path)
    living.day(kitchen=5000.0, den=5000.0)
    living.day(kitchen=1000.0, den=450.0)
    living.robot.rooms = replace(ROOMS[0], name="Küche"), ROOMS[1]
    living.keeper.look(DOCKED)
    living.again()
    living.keeper.look(DOCKED)
    assert living.day(Küche=1000.0) == [CleanRequest(CleanMode.ROOMS, ("Küche",))]
    needs = plans_of(living.keeper.view())["needs"]
    assert [(need["room"], need["every"]) for need in needs] == [("Küche", 1), ("den", 2)]


def test_where_nothing_is_due_nothing_begins_and_that_is_noted(tmp_path: Path) -> None:
    living = Living(tmp_path)
    only_den = PlannedOrder(mode=CleanMode.ROOMS, rooms=("den",), only_due=True)
    kitchen = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen", "den"), only_due=True)
    plan = DUE.model_copy(update={"order": kitchen})
    living.keeper.change(lambda all_: replaced(all_, "plans", DUE.name, plan))
    living.keeper.look(DOCKED)
    living.day(kitchen=5.0, den=5.0)
    living.day(kitchen=1000.0, den=0.0)
    living.keeper.change(
        lambda all_: replaced(all_, "plans", DUE.name, plan.model_copy(update={"order": only_den}))
    )
    living.keeper.look(DOCKED)
    assert living.day() == []
    assert living.keeper.view().notes[-1].text == "no room is due by its dirt"


def test_without_rooms_all_floor_is_cleaned(tmp_path: Path) -> None:
    living = Living(tmp_path)
    living.robot.home = lambda: HOME  # type: ignore[method-assign]
    assert living.day() == [CleanRequest(CleanMode.WHOLE)]


def test_only_floor_and_rooms_can_be_due() -> None:
    with pytest.raises(ValueError, match="those that are due"):
        PlannedOrder(mode=CleanMode.EDGES, only_due=True)


@pytest.mark.parametrize("is_killed", [False, True])
@pytest.mark.parametrize("refused", ["rooms.json", "plans.json", "dirt.json", "agenda.json"])
def test_names_that_changed_places_are_followed_once_whatever_the_disk_refuses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, refused: str, is_killed: bool
) -> None:
    living = Living(tmp_path)
    order = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen",))
    living.keeper.change(lambda all_: replaced(all_, "plans", "one", Plan(name="one", order=order)))
    living.day(kitchen=5000.0, den=5000.0)
    living.day(kitchen=1000.0, den=450.0)
    before = rates(tmp_path)
    assert before["kitchen"] > before["den"] > 0.0
    living.robot.rooms = replace(ROOMS[0], name="den"), replace(ROOMS[1], name="kitchen")
    write = KeptValues.write
    failed: list[str] = []

    def refuse(kept: KeptValues, values: Frozen) -> None:
        if kept._path.name == refused and not failed:
            failed.append(refused)
            raise OSError("No space left on device")
        write(kept, values)

    with monkeypatch.context() as full:
        full.setattr(KeptValues, "write", refuse)
        with pytest.raises(OSError, match="No space left"):
            living.keeper.look(DOCKED)
    if is_killed:
        living.again()
    for _ in range(3):
        living.keeper.look(DOCKED)
    [one] = [plan for plan in living.keeper.view().household.plans if plan.name == "one"]
    assert one.order.rooms == ("den",)
    after = rates(tmp_path)
    assert (after["den"], after["kitchen"]) == (before["kitchen"], before["den"])


def test_plans_go_on_while_the_disk_refuses_what_is_learned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    living = Living(tmp_path)
    living.day(kitchen=5000.0, den=5000.0)
    write = KeptValues.write

    def refuse(kept: KeptValues, values: Frozen) -> None:
        if kept._path.name == "dirt.json":
            raise OSError("No space left on device")
        write(kept, values)

    before = (tmp_path / "dirt.json").read_bytes()
    with monkeypatch.context() as full:
        full.setattr(KeptValues, "write", refuse)
        living.now = living.now.replace(hour=9, minute=1)
        living.keeper.look(DOCKED)
        living.keeper.look(VIEW)
        living.now += dt.timedelta(hours=1)
        report = CleanReport(ErrandOutcome.COMPLETED, "", 8.0, 8.0, 1.0, 30.0, 60.0, 1.0)
        found = replace(report, rooms=(RoomDirt("kitchen", 1.0, 1000.0),))
        last = replace(DOCKED, last=found)
        for _ in range(2):
            with pytest.raises(OSError, match="No space left"):
                living.keeper.look(last)
        assert living.keeper.view().running == ""
        living.now += dt.timedelta(days=1)
        with pytest.raises(OSError, match="No space left"):
            living.keeper.look(last)
        assert living.keeper.view().running == "daily"
    assert (tmp_path / "dirt.json").read_bytes() == before
    living.keeper.look(last)
    assert rates(tmp_path)["kitchen"] > 0.0


def rates(folder: Path) -> dict[str, float]:
    """Return how fast rooms become dirty, as it was kept."""
    records = KeptValues(folder / "dirt.json", print).read(DirtRecords())
    return {name: record.rate or 0.0 for name, record in records.rooms.items()}
