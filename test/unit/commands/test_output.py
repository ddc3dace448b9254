"""What the commands tell: tables of names and texts, times, figures for programs."""

from __future__ import annotations

import io
import json
import resource
from pathlib import Path

import pytest
from rich.console import Console

from roomba.commands.output import clock, named_table, pose_as_json, write_json
from roomba.geometry import Pose


@pytest.mark.parametrize(
    ("seconds", "text"), [(5.4, "5 s"), (61.0, "1 min 01 s"), (7260.0, "2 h 01 min")]
)
def test_times_as_people_say_them(seconds: float, text: str) -> None:
    assert clock(seconds) == text


def test_a_table_has_a_line_for_each_name_and_shows_brackets_as_they_are() -> None:
    told = io.StringIO()
    table = named_table([("way", "5 m"), ("missed", "[red]")], {"way": "green"})
    Console(file=told, width=40, force_terminal=False).print(table)
    assert [line.split() for line in told.getvalue().splitlines()] == [
        ["way", "5", "m"],
        ["missed", "[red]"],
    ]


def test_a_pose_is_told_to_a_tenth_of_a_millimetre() -> None:
    told = pose_as_json(Pose(1.00004, -2.00006, 0.1234567))
    assert told == {"x": 1.0, "y": -2.0001, "theta": 0.123457}


def test_figures_are_written_as_one_line_and_never_as_what_json_does_not_have(
    tmp_path: Path,
) -> None:
    file = tmp_path / "figures.json"
    write_json(str(file), {"way": 5.0})
    assert json.loads(file.read_text(encoding="utf-8")) == {"way": 5.0}
    with pytest.raises(ValueError, match="JSON"):
        write_json(str(file), {"way": float("nan")})


def test_figures_are_written_whole_or_not_at_all(tmp_path: Path) -> None:
    file, before = tmp_path / "figures.json", resource.getrlimit(resource.RLIMIT_FSIZE)
    write_json(str(file), {"way": 5.0})
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
        with pytest.raises(OSError, match="too large"):
            write_json(str(file), {"ways": [5.0] * 1000})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert json.loads(file.read_text(encoding="utf-8")) == {"way": 5.0}
    assert list(tmp_path.iterdir()) == [file]
