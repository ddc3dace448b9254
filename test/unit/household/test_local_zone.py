"""The zone of this computer."""

from __future__ import annotations

from pathlib import Path

from roomba.household.local_zone import local_zone


def test_the_environment_comes_before_the_link_and_utc_is_the_last_resort(tmp_path: Path) -> None:
    link = tmp_path / "localtime"
    assert local_zone({}, link) == "UTC"
    link.symlink_to("/usr/share/zoneinfo/Europe/Berlin")
    assert local_zone({}, link) == "Europe/Berlin"
    assert local_zone({"TZ": ":Asia/Tokyo"}, link) == "Asia/Tokyo"
    assert local_zone({"TZ": "CET-1CEST,M3.5.0,M10.5.0/3"}, link) == "Europe/Berlin"
