"""Doubting the pose: a home that changed, a robot that was carried, one that was wrong before."""

from __future__ import annotations

from typing import Any

import pytest
from fixtures.robots.located import CONFIG, LIDAR, TWO_ROOMS, Eye

from roomba.geometry import Pose
from roomba.perception.localization import doubt
from roomba.perception.localization.doubt import Doubt
from roomba.perception.localization.search.relocation import Expectation, Relocation, Verdict
from roomba.perception.matching.surface_field import SurfaceField

FIELD = SurfaceField.of(TWO_ROOMS.map)
HERE = Pose(1.5, 1.0, 0.3)
ELSEWHERE = Pose(6.0, 2.0, 2.0)
RECKONED = Pose(-3.0, 2.0, 1.0)
"""Where dead reckoning says that it stands, in a frame of its own."""
SCAN = 0.2
"""s; from scan to scan."""


class Rig:
    """A robot that stands at ``place`` and believes itself ``believed``."""

    def __init__(self, place: Pose, believed: Pose) -> None:
        self.believed = believed
        self.eye = Eye(TWO_ROOMS)
        self.doubt = Doubt(CONFIG.localization, CONFIG.body.radius)
        self.show(place, 10.0)
        self.place = place

    def show(self, place: Pose, stamp: float) -> None:
        self.doubt.note(stamp, RECKONED, LIDAR.view(self.eye.scan(place)))

    def asked(self, now: float) -> Expectation | None:
        view = LIDAR.view(self.eye.scan(self.place))
        return self.doubt.expected(now, now, view, RECKONED, self.believed, FIELD)

    def answers(self, seconds: float, now: float = 12.0) -> list[Expectation | None]:
        """Ask as often as scans come."""
        found = []
        for number in range(round(seconds / SCAN)):
            stamp = now + SCAN * number
            self.show(self.place, stamp)
            found.append(self.asked(stamp))
        return found


def test_where_it_is_right_and_sees_what_it_saw_it_keeps_its_pose() -> None:
    assert set(Rig(HERE, HERE).answers(4.0)) == {None}


def test_carried_away_it_is_to_be_searched_for_at_once() -> None:
    rig = Rig(HERE, HERE)
    rig.place = ELSEWHERE
    expected = rig.asked(12.0)
    assert expected is not None
    assert expected.is_met(HERE)
    assert not expected.is_met(ELSEWHERE)


def test_wrong_before_it_finds_that_out_though_it_was_not_carried() -> None:
    found = [answer for answer in Rig(ELSEWHERE, HERE).answers(4.0) if answer is not None]
    assert found
    assert found[0].is_met(HERE)
    carried = Rig(HERE, HERE)
    carried.place = ELSEWHERE
    moved = carried.asked(12.0)
    # It takes more to believe that it is elsewhere though it was not carried.
    assert moved is not None
    assert found[0].evidence > moved.evidence


class Slow(Relocation):
    """Takes three scans, and finds no place."""

    begun = 0

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        Slow.begun += 1
        self.left = 3

    def advance(self) -> None:
        self.left -= 1

    @property
    def verdict(self) -> Verdict:
        return Verdict.SEARCHING if self.left > 0 else Verdict.NOWHERE


@pytest.mark.parametrize(("drops", "begun"), [(False, 1), (True, 2)])
def test_comparing_goes_on_from_scan_to_scan_unless_it_is_dropped(
    monkeypatch: pytest.MonkeyPatch, drops: bool, begun: int
) -> None:
    monkeypatch.setattr(doubt, "Relocation", Slow)
    monkeypatch.setattr(Slow, "begun", 0)
    rig = Rig(HERE, HERE)
    rig.asked(12.0)
    if drops:
        rig.doubt.drop()
    rig.asked(12.2)
    assert Slow.begun == begun


def test_without_another_place_it_compares_again_after_a_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(doubt, "Relocation", Slow)
    monkeypatch.setattr(Slow, "begun", 0)
    rig = Rig(HERE, HERE)
    # It ends at 12.4 s, and may begin again from 13.4 s on.
    assert rig.answers(1.2) == [None] * 6
    assert Slow.begun == 1
    rig.answers(0.5, now=13.5)
    assert Slow.begun == 2


def test_driven_on_without_a_scan_that_fits_the_place_is_unsure_until_one_does() -> None:
    """By the way, not by how far it came: it may go in circles."""
    doubt = Doubt(CONFIG.localization, CONFIG.body.radius)
    way = CONFIG.localization.searching.doubted_way
    there, back = Pose(0.4 * way, 0.0, 0.0), Pose(0.0, 0.0, 0.0)
    for reckoned, lasts in ((back, False), (there, False), (back, False), (there, True)):
        doubt.follow(reckoned, fits=False)
        assert doubt.lasts == lasts
    doubt.follow(back, fits=True)
    assert not doubt.lasts
    doubt.follow(Pose(5.0, 0.0, 0.0), fits=False)
    assert not doubt.lasts


def test_a_place_that_is_told_or_found_is_doubted_no_more() -> None:
    doubt = Doubt(CONFIG.localization, CONFIG.body.radius)
    for number in range(5):
        doubt.follow(Pose(float(number), 0.0, 0.0), fits=False)
    assert doubt.lasts
    doubt.drop()
    assert not doubt.lasts
