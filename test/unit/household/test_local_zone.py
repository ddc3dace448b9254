"""The zone of this computer."""

from __future__ import annotations

import datetime as dt
import os
import zoneinfo
from pathlib import Path

import pytest

from roomba.household.local_zone import LocalZone, local_zone

ZONES = Path("/usr/share/zoneinfo")
CENTRAL_EUROPE = "CET-1CEST,M3.5.0,M10.5.0/3"


@pytest.fixture
def etc(tmp_path: Path) -> Path:
    return tmp_path


def link(etc: Path, zone: str) -> None:
    (etc / "localtime").symlink_to(ZONES / zone)


def copy(etc: Path, zone: str) -> None:
    (etc / "localtime").write_bytes((ZONES / zone).read_bytes())


def test_the_environment_comes_before_the_link(etc: Path) -> None:
    link(etc, "Europe/Berlin")
    assert local_zone({}, etc) == LocalZone("Europe/Berlin")
    assert local_zone({"TZ": ":Asia/Tokyo"}, etc) == LocalZone("Asia/Tokyo")
    assert local_zone({"TZ": f":{etc / 'localtime'}"}, etc) == LocalZone("Europe/Berlin")
    assert local_zone({"TZ": CENTRAL_EUROPE}, etc) == LocalZone("Europe/Berlin")


@pytest.mark.parametrize("zone", ["Europe/Berlin", "America/New_York", "Asia/Kolkata", "UTC"])
def test_a_copy_of_a_zone_is_known_by_what_it_holds(etc: Path, zone: str) -> None:
    """As in containers, which are given the file alone."""
    copy(etc, zone)
    assert local_zone({}, etc) == LocalZone(zone)
    # What the container was made with says nothing of it.
    (etc / "timezone").write_text("Pacific/Apia\n", "utf-8")
    assert local_zone({}, etc) == LocalZone(zone)


def test_of_zones_of_the_same_hours_the_other_file_decides(etc: Path) -> None:
    copy(etc, "Europe/Berlin")
    (etc / "timezone").write_text("Europe/Rome\n", "utf-8")
    assert local_zone({}, etc) == LocalZone("Europe/Rome")


def test_a_rule_finds_a_zone_of_the_same_hours(etc: Path) -> None:
    link(etc, "Etc/UTC")
    found = local_zone({"TZ": CENTRAL_EUROPE}, etc)
    assert found.doubt == ""
    for month in (1, 7):
        moment = dt.datetime(2026, month, 1)
        here, berlin = (zoneinfo.ZoneInfo(name) for name in (found.name, "Europe/Berlin"))
        assert moment.replace(tzinfo=here).utcoffset() == moment.replace(tzinfo=berlin).utcoffset()


def test_without_a_zone_file_the_name_is_read_and_utc_is_the_last_resort_and_told(
    etc: Path,
) -> None:
    found = local_zone({}, etc)
    assert found.name == "UTC"
    assert "localtime" in found.doubt
    (etc / "localtime").write_bytes(b"TZif2, damaged")
    assert local_zone({}, etc).doubt != ""
    (etc / "timezone").write_text("Europe/Berlin\n", "utf-8")
    assert local_zone({}, etc) == LocalZone("Europe/Berlin")


def test_what_the_environment_tells_and_is_no_zone_is_told(etc: Path) -> None:
    link(etc, "Etc/UTC")
    found = local_zone({"TZ": "Europe/Berlln"}, etc)
    assert found.name == "Etc/UTC"
    assert "'Europe/Berlln'" in found.doubt


@pytest.mark.parametrize("given", [b"CET\xff", b":Europe/M\xfcnchen", b"/etc/\xff"])
def test_bytes_that_are_no_text_are_told_as_well(etc: Path, given: bytes) -> None:
    link(etc, "Etc/UTC")
    found = local_zone({"TZ": os.fsdecode(given)}, etc)
    assert found.name in ("UTC", "Etc/UTC")
    assert "\\udc" in found.doubt
    found.doubt.encode()
