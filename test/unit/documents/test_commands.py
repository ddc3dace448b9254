"""Every ``./roomba`` line of the documents is one that the command takes: parsed, not run."""

from __future__ import annotations

import argparse
import importlib
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest
from running.suites import SUITES

from roomba.commands import program
from roomba.errors import RoombaError

ROOT = Path(__file__).parents[3]
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "benchmarks/README.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "benchmarks" / "measured").glob("*.md")),
]
MODULES = {
    "campaign": "roomba.commands.campaign.command",
    "sim": "roomba.commands.sim.command",
    "map": "roomba.commands.map.command",
    "map --bag": "roomba.commands.map.drive.command",
    "control": "roomba.commands.control.command",
    "play": "roomba.commands.play.command",
    "top": "roomba.commands.top.command",
    "replay": "roomba.commands.play.replay",
    "report": "roomba.commands.report.command",
    "import": "roomba.commands.valetudo.import_command",
    "export": "roomba.commands.export.command",
    "export valetudo": "roomba.commands.valetudo.export_command",
    "record": "roomba_ros.bags.record",
    "pictures": "roomba.commands.pictures.__main__",
    "bench": "roomba_bench.__main__",
    "soak": "soak.__main__",
    "fuzz": "fuzz.__main__",
    "emulate": "roomba.commands.emulate.command",
    "localize": "roomba.commands.localize.command",
    "exercise": "roomba.commands.exercise.command",
}
"""The module whose ``main`` parses what follows a command; the others are told below."""
PROGRAMS = {
    "dask",
    "rosnode",
    "rostopic",
    "rosservice",
    "roscore",
    "rosparam",
    "rosbag",
    "rviz",
    "bash",
}
"""What ``./roomba exec`` runs of others, whose arguments are theirs."""
MENTIONED = {"import valetudo", "map --bag", "emulate", "play --smart-home", "sim --homes N"}
"""What the text names without the rest of the line."""


class Parsed(Exception):  # noqa: N818 - it is no error
    """The parser of a command took the arguments: the command is to do nothing."""


def test_of_the_documents_are_all_commands() -> None:
    lines = documented_lines()
    assert len(lines) > 80
    told = {line.split()[0] for line in lines}
    assert told == commands_of_help()


def test_each_command_of_the_help_is_known_to_both_programs() -> None:
    of_library = {*program._COMMANDS, *program._NEED_ROS, *program._NEED_CHECKOUT}
    assert of_library | {"version", "help"} == commands_of_help()
    cases = (ROOT / "roomba").read_text().split("case $command in")[1]
    labels = re.findall(r"^    ([a-z][-a-z |]*)\)", cases, re.MULTILINE)
    of_checkout = {word for label in labels for word in label.split(" | ") if word[0] != "-"}
    assert of_checkout == commands_of_help()


def documented_lines() -> list[str]:
    """Return what follows ``./roomba`` in blocks and in the text, without comments, each once."""
    found = []
    for page in PAGES:
        for line in page.read_text(encoding="utf-8").splitlines():
            block = re.match(r"    \./roomba (.*)", line)
            if block:
                found.append(re.split(r"  +#| # |\s{4,}", block[1])[0].strip())
                continue
            found += re.findall(r"`\./roomba ([^`]+)`", line)
    whole = [line.replace("\\|", "|") for line in found]
    return sorted(set(whole))


def commands_of_help() -> set[str]:
    """Return the commands that ``./roomba help`` lists."""
    usage = (ROOT / "src" / "roomba" / "commands" / "usage.txt").read_text(encoding="utf-8")
    return set(re.findall(r"^  ([a-z]+)[ \[]", usage, re.MULTILINE))


def is_whole(line: str) -> bool:
    """Whether a line can be typed: it has no parts that may be left out, and more than a name."""
    return not re.search(r"[\[\]…|]", line) and bool(line.split()[1:]) and line not in MENTIONED


@pytest.mark.parametrize("line", documented_lines())
def test_a_line_names_a_command(line: str) -> None:
    assert line.split()[0] in commands_of_help()


@pytest.mark.parametrize("line", [line for line in documented_lines() if is_whole(line)])
def test_a_line_is_taken_by_its_parser(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    take(line, monkeypatch)


@pytest.mark.parametrize(
    "line",
    [
        "sim --hom flat",
        "sim --seed x",
        "map --seed 1 --bag-of drive.bag",
        "map --bag drive.bag --home flat",
        "run hoem:=flat",
        "exec python examples/no_such_file.py",
        "exec rosrun roomba_robot no_such_node.py",
        "test no_such_suite",
        "doctor --colour",
        "control now",
    ],
)
def test_what_is_wrong_is_refused(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises((AssertionError, RoombaError, SystemExit)):
        take(line, monkeypatch)


def take(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Parse a line as ``./roomba`` would; raises what its parser raises, or AssertionError."""
    command, *words = shlex.split(line)
    if command == "map" and any(word.startswith("--bag") for word in words):
        command = "map --bag"
    if command in ("run", "exec", "control", "camera") and words[:1] == ["--isolated"]:
        words = words[1:]
    if command == "export" and words[0] == "valetudo":
        command = "export valetudo"
    if command == "run":
        take_launch_arguments(words)
    elif command == "exec":
        take_program(*words)
    elif command == "test":
        take_suites(words)
    elif command == "doctor":
        assert set(words) <= {"--json"}
    elif command == "docs":
        assert words in ([], ["--serve"])
    elif command in MODULES:
        if command in ("localize", "record"):
            pytest.importorskip("roomba_robot.msg", reason="needs ROS, as the command does")
        parse(importlib.import_module(MODULES[command]), words, monkeypatch)
    else:
        assert words == [], f"{command} takes no arguments"


def parse(module: object, words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a command's own parser take the words, and end there."""
    parse_args = argparse.ArgumentParser.parse_args

    def only_parse(
        self: argparse.ArgumentParser, args: list[str] | None = None
    ) -> argparse.Namespace:
        parse_args(self, args)
        raise Parsed

    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", only_parse)
    main = getattr(module, "main")  # noqa: B009 - of any module
    try:
        status = main(words)
    except Parsed:
        return
    raise AssertionError(f"it ended with {status} before it had parsed {words}")


def take_launch_arguments(words: list[str]) -> None:
    launch = ElementTree.parse(ROOT / "launch" / "roomba_robot.launch").getroot()
    known = {arg.get("name") for arg in launch.iter("arg")}
    for word in words:
        name, sign, _ = word.partition(":=")
        assert sign, f"expected name:=value, got {word}"
        assert name in known, f"{name} is no argument of the launch file"


def take_program(program: str, *words: str) -> None:
    """Check a line of ``./roomba exec``: its files, modules, nodes and services are there."""
    if program == "python" and words[0] == "-m":
        assert words[1] == "pip" or file_of_module(words[1]).is_file()
    elif program == "python" and words[0] != "FILE":
        assert (ROOT / words[0]).is_file()
    elif program == "rviz" and words:
        assert words[0] == "-d"
        assert (ROOT / words[1]).is_file()
    elif program == "rosrun":
        assert words[0] == "roomba_robot"
        assert (ROOT / "scripts" / words[1]).is_file()
    elif program == "rosservice":
        interface = (ROOT / "docs" / "ros_interface.md").read_text(encoding="utf-8")
        assert words[0] == "call"
        assert f"`{words[1]}`" in interface
    else:
        assert program == "python" or program in PROGRAMS


def file_of_module(name: str) -> Path:
    """Return the file that runs when a module, or a package, is named."""
    path = ROOT.joinpath("src", *name.split("."))
    return path / "__main__.py" if path.is_dir() else path.with_suffix(".py")


def take_suites(words: list[str]) -> None:
    """Check that a line of ``./roomba test`` begins with suites or files, and then has options."""
    rest = words[1:] if words[0] in ("quick", "thorough", "mutants") else words
    while rest and rest[0] in SUITES:
        rest = rest[1:]
    if rest and not rest[0].startswith("-"):
        assert (ROOT / rest[0]).exists(), f"{rest[0]} is no suite and no file"
