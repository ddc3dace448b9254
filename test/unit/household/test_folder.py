"""The folder of the household, and how its keepers deal with any day in its files."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from fixtures.households.kept_household import (
    AGENDA,
    DIRT,
    FIRST_AND_LAST,
    PLANS,
    content_of,
    read_household,
)

from roomba.configuration.frozen import Frozen
from roomba.files.kept import write_kept
from roomba.household.folder import KeptValues, household_folder
from roomba.plans.plan import HouseholdPlans


def test_the_folder_is_the_named_one_or_lies_in_the_state_folder() -> None:
    assert household_folder({"ROOMBA_HOUSEHOLD": "/own", "ROS_HOME": "/ros"}) == Path("/own")
    assert household_folder({"ROOMBA_HOUSEHOLD": "own", "ROS_HOME": "/ros"}) == Path(
        "/ros/roomba_robot/household"
    )


@pytest.mark.parametrize(
    ("name", "whole"), [("agenda.json", AGENDA), ("plans.json", PLANS), ("dirt.json", DIRT)]
)
def test_files_with_a_day_at_an_end_of_the_calendar_are_read_or_begun_anew(
    name: str, whole: Frozen, tmp_path: Path
) -> None:
    text = content_of(whole).decode()
    days = [found.span() for found in re.finditer(r'(?<=")\d{4}-\d\d-\d\d(T[^"]*)?(?=")', text)]
    assert days
    for number, ((begin, end), moment) in enumerate(itertools.product(days, FIRST_AND_LAST)):
        path = tmp_path / str(number) / name
        path.parent.mkdir()
        said = moment if "T" in text[begin:end] else moment[:10]
        path.write_text(text[:begin] + said + text[end:], "utf-8")
        read_household(path)


def test_what_a_newer_program_wrote_is_not_written_over(tmp_path: Path) -> None:
    path, told = tmp_path / "plans.json", list[str]()
    write_kept(path, b'{"new": 1}', 99)
    before, kept = path.read_bytes(), KeptValues(path, told.append)
    assert kept.read(HouseholdPlans()) == HouseholdPlans()
    (line,) = told
    assert f"{path}: expected version 1 or older, got 99" in line
    assert "nothing is kept there" in line
    with pytest.raises(OSError, match=r"not kept: .*newer program"):
        kept.write(PLANS)
    assert path.read_bytes() == before
    path.unlink()
    assert kept.read(HouseholdPlans()) == HouseholdPlans()
    kept.write(PLANS)
    assert kept.read(HouseholdPlans()) == PLANS


def test_what_could_not_be_read_again_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "plans.json"
    kept = KeptValues(path, pytest.fail)
    kept.write(PLANS)
    with pytest.raises(OSError, match="expected at most 4000000 bytes"):
        kept.write(HouseholdPlans.model_construct(zone="x" * 4_000_000))
    assert kept.read(HouseholdPlans()) == PLANS
