"""The text of a CARMEN log: which lines are read, which are ignored, which are refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.recordings.carmen.text import CarmenText
from roomba.recordings.readings import LogError

FLASER = "FLASER 3 1.0 2.0 81.83 0.1 0.2 0.3 0.1 0.2 0.3 12.5 nohost 0.25"


def text_of(tmp_path: Path, *lines: str) -> CarmenText:
    (tmp_path / "made.log").write_text("\n".join(lines) + "\n", "utf-8")
    return CarmenText(tmp_path / "made.log")


def test_lines_and_parameters_are_told_from_all_else(tmp_path: Path) -> None:
    text = text_of(
        tmp_path,
        "# a comment",
        "",
        "PARAM robot_frontlaser_offset 0.2 nohost 0",
        "PARAM robot_width 0.5 nohost 0",
        "NEWS a b",
        "NEWS c",
        FLASER,
    )
    assert [line.word for line in text.lines] == ["FLASER"]
    assert text.parameters == {"robot_frontlaser_offset": 0.2}
    assert text.other == {"NEWS": 2}
    assert text.notes == []


def test_a_mark_before_the_first_line_is_no_part_of_it(tmp_path: Path) -> None:
    text = text_of(tmp_path, "\ufeffPARAM robot_frontlaser_offset 0.2 nohost 0", FLASER)
    assert text.parameters == {"robot_frontlaser_offset": 0.2}
    assert text.other == {}


def test_of_lines_that_cannot_be_read_the_first_is_told(tmp_path: Path) -> None:
    text = text_of(tmp_path, "PARAM robot_frontlaser_offset", FLASER, "FLASER x")
    assert text.notes == [
        "2 lines of made.log cannot be read: left out (the first: line 1, PARAM: it has 2 words "
        "only)"
    ]


def test_a_log_of_broken_lines_alone_is_refused_with_what_is_wrong_with_the_first(
    tmp_path: Path,
) -> None:
    lines = ["# a comment", "FLASER 2 1,0 2,0 0 0 0 0 0 0 1 h 1"]
    with pytest.raises(LogError, match=r"got none; 1 lines of .* line 2, FLASER: .*'1,0'"):
        text_of(tmp_path, *lines)


@pytest.mark.parametrize("content", ["x" * 100_000, "\n".join(f"word{n}" for n in range(5000))])
def test_a_file_of_another_kind_is_refused_in_a_short_line(tmp_path: Path, content: str) -> None:
    with pytest.raises(LogError, match="of a CARMEN log, got none; it has ") as refused:
        text_of(tmp_path, content)
    assert len(str(refused.value)) < 500 + len(str(tmp_path))


def test_a_text_that_is_no_log_is_refused_with_what_it_has(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"expected lines FLASER.*it has To, whom"):
        text_of(tmp_path, "To be or not", "whom it may concern")


def test_a_text_of_numbers_is_told_what_a_line_begins_with(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"begin with numbers, as 1\.5: a line"):
        text_of(tmp_path, "1.5 2.5", "1.5 3.5", "word")
