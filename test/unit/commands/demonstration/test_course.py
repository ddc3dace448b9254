"""A demonstration begins with real programs; its whole, half an hour, is in the documents."""

from __future__ import annotations

import datetime as dt
import json
from pathlib import Path

import numpy as np
import pytest
from fixtures.thoroughness import core_first
from fixtures.waiting import wait_until
from PIL import Image

from roomba.commands.demonstration.command import tiled, written
from roomba.commands.demonstration.course import SHOWN, Demonstration, Seen
from roomba.commands.demonstration.listener import HeardMessage
from roomba.commands.demonstration.programs import RunningPrograms
from roomba.errors import RoombaError

DUE = dt.datetime(2026, 3, 2, 8, 0, tzinfo=dt.timezone.utc)


@pytest.mark.parametrize("name", core_first(SHOWN, ["create2"]))
def test_broker_robot_and_brain_are_started_and_the_robot_waits_for_its_plan(
    name: str, tmp_path: Path
) -> None:
    course = Demonstration(SHOWN[name], tmp_path, lambda text: None)
    try:
        listener, owner = course.begin("studio", 1)
        wait_until(lambda: listener.state().get("phase") == "docked", 30.0, "it is docked")
        assert owner.runs() == owner.notes() == []
        listener.say("command", "dance")
        wait_until(lambda: listener.messages("answer"), 10.0, "an answer")
        assert not listener.messages("answer")[0].values()["ok"]
        listener.end()
    finally:
        course.end()
    assert not list(tmp_path.glob("*_line")), "the made-up robot's lines are gone"


def test_a_program_that_does_not_begin_is_told_with_what_it_printed(tmp_path: Path) -> None:
    programs = RunningPrograms(tmp_path)
    with pytest.raises(RoombaError, match="expected the name of a home"):
        programs.start_robot(["neato", "--home", "nowhere"], [tmp_path / "line"])
    programs.end()


def test_what_was_seen_is_written(tmp_path: Path) -> None:
    page = np.zeros((40, 60, 3), np.uint8)
    values = {"state": "docked", "phase": "docked", "battery": 100.0, "area": 9.5, "error": "none"}
    state = HeardMessage(DUE.timestamp() + 61.0, "state", json.dumps(values).encode())
    seen = Seen(DUE, [page, page, page, np.full_like(page, 255)], states=[state])
    seen.run, seen.report = {"outcome": "completed"}, page
    files = written(seen, tmp_path, "shown")
    text = files[0].read_text("utf-8")
    assert "| 1:01 | docked | 100 % | 9.5 m² |" in text
    assert "- outcome: completed" in text
    assert [file.name for file in files] == ["shown.md", "shown.png", "shown_report.png"]
    assert np.array(Image.open(files[1]).convert("RGB"))[-1, -1].tolist() == [255, 255, 255]


def test_pages_are_two_rows() -> None:
    pages = [np.full((40, 60, 3), grey, np.uint8) for grey in (10, 20, 30, 40)]
    picture = tiled(pages)
    corners = picture[0, 0, 0], picture[0, -1, 0], picture[-1, 0, 0], picture[-1, -1, 0]
    assert corners == (10, 20, 30, 40)
