"""When an errand is given up because the robot does not know its pose."""

from __future__ import annotations

from roomba.configuration.loops import WalkConfig
from roomba.mission.driving.search_patience import SearchPatience
from roomba.perception.localization.estimate import Knowledge

CONFIG = WalkConfig()


def test_a_search_has_its_time() -> None:
    patience = SearchPatience(CONFIG, Knowledge.KNOWN)
    assert not patience.is_over(Knowledge.SEARCHING, CONFIG.astray_timeout)
    assert patience.is_over(Knowledge.SEARCHING, CONFIG.astray_timeout + 0.1)


def test_lost_on_its_way_it_gives_up_at_once() -> None:
    patience = SearchPatience(CONFIG, Knowledge.KNOWN)
    assert not patience.is_over(Knowledge.SEARCHING, 1.0)
    assert patience.is_over(Knowledge.LOST, 1.1)


def test_one_that_stood_lost_looks_around_first() -> None:
    patience = SearchPatience(CONFIG, Knowledge.LOST)
    assert not patience.is_over(Knowledge.LOST, CONFIG.search_wait)
    assert patience.is_over(Knowledge.LOST, CONFIG.search_wait + 0.1)


def test_one_that_is_lost_again_gives_up_at_once() -> None:
    patience = SearchPatience(CONFIG, Knowledge.LOST)
    assert not patience.is_over(Knowledge.SEARCHING, CONFIG.search_wait + 0.1)
    assert patience.is_over(Knowledge.LOST, CONFIG.search_wait + 0.2)


def test_each_errand_begins_with_what_is_known_then() -> None:
    patience = SearchPatience(CONFIG, Knowledge.KNOWN)
    patience.begin(Knowledge.LOST)
    assert not patience.is_over(Knowledge.LOST, 0.1)
    patience.begin(Knowledge.KNOWN)
    assert patience.is_over(Knowledge.LOST, 0.1)
