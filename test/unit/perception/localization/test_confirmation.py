"""A pose that was told: taken, kept until it is compared, or refuted, by how well a scan fits."""

from __future__ import annotations

from fixtures.located import CONFIG, LIDAR, TWO_ROOMS, Eye

from roomba.geometry import Pose
from roomba.perception.localization.confirmation import Confirmation
from roomba.perception.localization.doubt import Doubt
from roomba.perception.localization.relocation import Expectation
from roomba.perception.matching.scan_view import Fit
from roomba.perception.matching.surface_field import SurfaceField

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

    def show(self, fit: Fit) -> Expectation | None:
        return self.confirmation.refuted(6.0, fit, self.view, RECKONED, FIELD)

    def show_until_told(self, fit: Fit) -> Expectation | None:
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
    assert refuted.is_met(HERE)
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
    assert refuted.is_met(HERE)


def test_what_has_more_evidence_needs_a_fair_fit_only_until_another_pose_is_told() -> None:
    rig = Rig()
    rig.confirmation.need_less()
    assert rig.show(FAIR) is None
    assert not rig.confirmation.is_open
    rig.confirmation.told(7.0, HERE, UNSURE)
    rig.show(FAIR)
    assert rig.confirmation.compared is not None


def test_another_pose_that_is_told_ends_a_comparison_and_dropping_ends_all() -> None:
    rig = Rig()
    rig.show(FAIR)
    rig.confirmation.told(7.0, ELSEWHERE, UNSURE)
    assert rig.confirmation.compared is None
    assert rig.confirmation.awaited is not None
    assert rig.confirmation.awaited.is_met(ELSEWHERE)
    rig.confirmation.drop()
    assert not rig.confirmation.is_open
