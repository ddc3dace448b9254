"""A pose that was told: taken, kept until it is compared, or refuted, by how well a scan fits."""

from __future__ import annotations

import math

from fixtures.robots.located import CONFIG, LIDAR, SQUARE, TWO_ROOMS, Eye
from fixtures.robots.missions import HOME

from roomba.geometry import Pose
from roomba.perception.localization.confirmation import Confirmation, Refuted
from roomba.perception.localization.doubt import Doubt
from roomba.perception.matching.scan_view import Fit
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home

FIELD = SurfaceField.of(TWO_ROOMS.map)
HERE = Pose(1.5, 1.0, 0.3)
ELSEWHERE = Pose(6.0, 2.0, 2.0)
RECKONED = Pose(-3.0, 2.0, 1.0)
UNSURE = (0.1, 0.1)
GOOD = Fit(0.98, 0.0, 0.01, 0.0)
FAIR = Fit(0.8, 0.1, 0.1, 0.0)
BAD = Fit(0.3, 0.4, 0.3, 0.0)


class Rig:
    """A robot that stands at ``place`` and was told to be at HERE."""

    def __init__(self, place: Pose = HERE) -> None:
        doubt = Doubt(CONFIG.localization, CONFIG.body.radius)
        self.confirmation = Confirmation(CONFIG.localization, doubt)
        self.view = LIDAR.view(Eye(TWO_ROOMS).scan(place))
        self.confirmation.told(5.0, HERE, UNSURE)

    def show(self, fit: Fit) -> Refuted | None:
        return self.confirmation.refuted(6.0, fit, self.view, RECKONED, FIELD)

    def find_near(self) -> Refuted | None:
        """Let it be found near by, at HERE."""
        self.confirmation.drop()
        return self.confirmation.compare_near(6.0, HERE, self.view, RECKONED, FIELD)

    def show_until_told(self, fit: Fit) -> Refuted | None:
        """Show the scan until the comparison is done."""
        for _ in range(1000):
            refuted = self.show(fit)
            if refuted is not None or not self.confirmation.is_open:
                return refuted
        raise AssertionError("the comparison does not end")


def test_a_scan_that_fits_well_confirms_it() -> None:
    rig = Rig()
    assert rig.confirmation.is_open
    assert rig.confirmation.told_at == 5.0
    assert rig.show(GOOD) is None
    assert not rig.confirmation.is_open


def test_a_scan_that_hardly_fits_refutes_it() -> None:
    rig = Rig()
    refuted = rig.show(BAD)
    assert refuted is not None
    assert refuted.expectation.is_met(HERE)
    assert "told" in refuted.why
    assert not rig.confirmation.is_open


def test_where_a_scan_fits_in_part_it_is_compared_and_kept_if_no_other_place_is_likelier() -> None:
    rig = Rig()
    assert rig.show(FAIR) is None
    assert rig.confirmation.awaited is None
    assert rig.confirmation.compared is not None
    assert rig.show_until_told(FAIR) is None


def test_where_a_scan_fits_in_part_another_place_that_is_likelier_refutes_it() -> None:
    refuted = Rig(ELSEWHERE).show_until_told(FAIR)
    assert refuted is not None
    assert refuted.expectation.is_met(HERE)
    assert "told" in refuted.why


def test_what_has_more_evidence_needs_a_fair_fit_only_until_another_pose_is_told() -> None:
    rig = Rig()
    rig.confirmation.need_less()
    assert rig.show(FAIR) is None
    assert not rig.confirmation.is_open
    rig.confirmation.told(7.0, HERE, UNSURE)
    rig.show(FAIR)
    assert rig.confirmation.compared is not None


def test_found_near_by_it_is_kept_if_no_other_place_is_as_likely() -> None:
    rig = Rig()
    assert rig.find_near() is None
    assert rig.show_until_told(GOOD) is None


def test_found_near_by_another_place_that_is_likelier_refutes_it_in_other_words() -> None:
    rig = Rig(ELSEWHERE)
    refuted = rig.find_near() or rig.show_until_told(FAIR)
    assert refuted is not None
    assert refuted.expectation.is_met(HERE)
    assert "carried" in refuted.why
    assert not rig.confirmation.is_open


def found_near(home: Home, place: Pose, believed: Pose) -> Refuted | None:
    """Stand at a place, be found near by at another, and compare until that is done."""
    field = SurfaceField.of(home.map)
    doubt = Doubt(CONFIG.localization, CONFIG.body.radius)
    confirmation = Confirmation(CONFIG.localization, doubt)
    view = LIDAR.view(Eye(home).scan(place))
    refuted = confirmation.compare_near(6.0, believed, view, RECKONED, field)
    for _ in range(1000):
        if refuted is not None or not confirmation.is_open:
            return refuted
        refuted = confirmation.refuted(6.0, FAIR, view, RECKONED, field)
    raise AssertionError("the comparison does not end")


def test_found_near_by_a_place_that_is_only_a_little_likelier_makes_it_unsure() -> None:
    """But for its station the room looks the same from the other side."""
    place = Pose(2.68, 1.33, -2.19)
    assert found_near(HOME, place, Pose(3.0 - place.x, 2.5 - place.y, place.theta + math.pi))


def test_found_near_by_it_is_kept_where_others_look_just_the_same() -> None:
    """It is likelier that its wheels slipped."""
    place = Pose(0.8, 1.1, 0.2)
    assert found_near(SQUARE, place, place) is None


def test_another_pose_that_is_told_ends_a_comparison_and_dropping_ends_all() -> None:
    rig = Rig()
    rig.show(FAIR)
    rig.confirmation.told(7.0, ELSEWHERE, UNSURE)
    assert rig.confirmation.compared is None
    assert rig.confirmation.awaited is not None
    assert rig.confirmation.awaited.is_met(ELSEWHERE)
    rig.confirmation.drop()
    assert not rig.confirmation.is_open
