"""Each exercise without ROS: what it begins with does not pass, and a solution does."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.thoroughness import core_first
from fixtures.waiting import promised

from roomba.commands.exercise import cover_floor, follow_path, match_scan
from roomba.commands.exercise.command import main
from roomba.commands.exercise.course import COURSE
from roomba.commands.exercise.verdict import NotYetError

SOLUTIONS = Path(__file__).with_name("solutions")
NUMBERS = {each.name: number for number, each in enumerate(COURSE, 1)}
WITHOUT_ROS = [each.name for each in COURSE if each.check.startswith("roomba.")]


@pytest.mark.parametrize("name", core_first(WITHOUT_ROS, {"shortest_path"}))
def test_a_solution_passes(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    file = SOLUTIONS / f"{name}.py"
    assert main([str(NUMBERS[name]), "--check", "--file", str(file)]) == 0, capfd.readouterr().out
    assert capfd.readouterr().out.startswith("passed: ")


@pytest.mark.parametrize("name", core_first(WITHOUT_ROS, {"shortest_path"}))
def test_what_a_learner_begins_with_does_not_pass_yet(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([str(NUMBERS[name])]) == 0
    assert capfd.readouterr().out.startswith(f"# {NUMBERS[name]}. ")
    assert main([str(NUMBERS[name]), "--check"]) == 1
    assert capfd.readouterr().out.startswith("not yet: ")


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        ("def shortest_path(free, start, goal):\n    return nothing\n", "line 2: return nothing"),
        ("def shortest_path(:\n", "SyntaxError: invalid syntax (shortest_path.py, line 1)\n"),
        ("way = 1\n", "expected a function shortest_path()"),
        ("import sys\nsys.exit(10)\n", "ended the check, with status 10"),
        ("def shortest_path(free, start, goal):\n    return 5\n", "does it fit the text?"),
        ("import os\nos._exit(9)\n", "ended the check, with status 9"),
        ("def shortest_path(free, start, goal):\n    return [start, goal]\n", "no neighbours"),
    ],
)
def test_what_is_wrong_is_told(
    answer: str, told: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "shortest_path.py"
    file.write_text(answer, "utf-8")
    assert main([str(NUMBERS["shortest_path"]), "--check", "--file", str(file)]) == 1
    assert told in capfd.readouterr().out


@pytest.mark.parametrize(
    ("check", "answer", "told"),
    [
        (
            cover_floor.check,
            "def coverage_path(free, start):\n"
            "    return [start, (2, 2), (47, 2), (47, 57), (2, 57)]\n",
            "floor are swept, expected 98%; the largest part that is left is in "
            "rows 0 to 44, columns 4 to 55",
        ),
        (
            follow_path.check,
            "def drive(pose, path, speed):\n    return 0.0, 90.0\n",
            "straight on: 90 rad/s is more than any robot turns; are these degrees?",
        ),
        (
            follow_path.check,
            "def drive(pose, path, speed):\n    return 0.0, 0.1\n",
            "has not told the robot to stand after 45 s, at (-2.00, -1.00), 3.50 m from the end",
        ),
        pytest.param(
            match_scan.check,
            (SOLUTIONS / "match_scan.py")
            .read_text("utf-8")
            .replace('loss="soft_l1", f_scale=0.02', 'loss="linear"'),
            "m off in the median, expected 0.02 m or less",
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_what_is_not_right_yet_is_told(
    check: Callable[[Path], str], answer: str, told: str, tmp_path: Path
) -> None:
    file = tmp_path / "answer.py"
    file.write_text(answer, "utf-8")
    with pytest.raises(NotYetError) as raised:
        check(file)
    assert told in str(raised.value)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "expected a function shortest_path() in notes.txt, there is none"),
        (b"\xe0\xff", "SyntaxError: "),
    ],
)
def test_a_file_of_another_kind_is_told_what_it_lacks(
    content: bytes, told: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "notes.txt"
    file.write_bytes(content)
    assert main([str(NUMBERS["shortest_path"]), "--check", "--file", str(file)]) == 1
    assert told in capfd.readouterr().out


def test_an_answer_that_never_ends_is_ended_with_what_it_began(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "shortest_path.py"
    begun = tmp_path / "begun"
    lines = (
        "import subprocess",
        "child = subprocess.Popen(['sleep', '600'])",
        f"open({str(begun)!r}, 'w').write(str(child.pid))",
        "while True: pass",
    )
    file.write_text("\n".join(lines), "utf-8")
    number = NUMBERS["shortest_path"]
    short = [type(each)(each.name, each.about, each.check, 3.0) for each in COURSE]
    monkeypatch.setattr("roomba.commands.exercise.command.COURSE", short)
    assert main([str(number), "--check", "--file", str(file)]) == 1
    assert "does a loop go on for ever?" in capfd.readouterr().out
    child = Path("/proc", begun.read_text("utf-8"), "stat")
    # One that was killed may not be waited for yet.
    promised(lambda: not child.exists() or " Z " in child.read_text(), 5.0, "it is ended")


def test_all_are_listed_and_a_file_of_the_learner_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([]) == 0
    told = capfd.readouterr().out
    assert all(each.about in told for each in COURSE)
    Path("follow_path.py").write_text("mine\n", "utf-8")
    assert main(["5"]) == 0
    assert Path("follow_path.py").read_text("utf-8") == "mine\n"


@pytest.mark.parametrize("arguments", [["0"], ["99"], ["--check"], ["4", "--check"], ["x"]])
def test_wrong_usage_is_refused(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2


def test_a_file_that_cannot_be_written_is_refused_in_a_line(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "no_such_folder" / "mine.py"
    assert main(["4", "--file", str(file)]) == 2
    assert (
        capfd.readouterr()
        .err.strip()
        .endswith(f"{file}: cannot be written: No such file or directory; name another")
    )
