"""Options of all commands: one thing is spelled in one way, and takes the same everywhere."""

from __future__ import annotations

import argparse
import importlib
from collections import defaultdict
from pathlib import Path

import pytest
from unit.documents.test_commands import MODULES

from roomba.commands.localize.options import options_of

Spelled = dict[str, dict[str, set[str]]]
"""Of each option what it takes, and the commands that have it so."""

ROS = {"record", "soak"}
"""What imports ROS as it starts."""
DIFFER = {
    "--bag": "a bag that is written, or recorded drives that are read",
    "--lidar": "the simulated one, or that a robot has none",
    "--map": "the map of a home, or whether a robot that lives in one knows it",
    "--out": "what is written: a folder, or a file of a kind",
    "--csv": "with a path there are several files, so none of them is standard output",
    "--json": "some tell of now alone, and write no file",
}
"""Options that take something else in another command, and why."""
OTHER_WORDS = {
    "--output": "--out",
    "--outfile": "--out",
    "--configuration": "--config",
    "--silent": "--quiet",
    "--workers": "--processes",
    "--plots": "--plot",
    "--picture": "--plot",
}
"""What options are not called, and what they are."""


class Seen(Exception):  # noqa: N818 - it is no error
    """The options of a command are known: it is to do nothing."""


@pytest.fixture(scope="module")
def spelled() -> Spelled:
    """Ask the parser of each command."""
    found: Spelled = defaultdict(lambda: defaultdict(set))
    with pytest.MonkeyPatch.context() as patch:
        for command, module in {**MODULES, "status": "roomba.commands.status.command"}.items():
            if command in ROS:
                continue

            def note(
                self: argparse.ArgumentParser, args: object = None, command: str = command
            ) -> argparse.Namespace:
                for action in self._actions:
                    takes = action.metavar or ("nothing" if action.nargs == 0 else "a word")
                    told = takes if isinstance(takes, str) else " ".join(takes)
                    for option in action.option_strings:
                        if action.help != argparse.SUPPRESS:
                            found[option][told].add(command)
                raise Seen

            patch.setattr(argparse.ArgumentParser, "parse_args", note)
            with pytest.raises(Seen):
                importlib.import_module(module).main([])
    return found


def test_the_options_of_many_commands_are_known(spelled: Spelled) -> None:
    assert len(spelled) > 50
    assert {"sim", "map", "campaign"} <= set.union(*spelled["--plot"].values())


def test_an_option_takes_the_same_in_every_command(spelled: Spelled) -> None:
    several = {option: dict(ways) for option, ways in spelled.items() if len(ways) > 1}
    assert several.keys() == DIFFER.keys(), several


def test_one_thing_has_one_word(spelled: Spelled) -> None:
    assert OTHER_WORDS.keys() & spelled.keys() == set()
    assert all(f"-{letter}" not in spelled for letter in "joqsv")


def test_what_was_spelled_otherwise_once_is_still_taken(tmp_path: Path) -> None:
    bag = tmp_path / "out.bag"
    usual = ["--map", "map.yaml", "--bag", "drive.bag"]
    assert options_of([*usual, "--output", str(bag)]) == options_of([*usual, "--out", str(bag)])
    assert options_of([*usual, "--output", str(bag)]).output == bag
