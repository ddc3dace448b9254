"""What the command lines of several commands share: values, and files that are refused."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

import pytest

from roomba.commands.options import (
    Parser,
    UsageError,
    check_config,
    check_written,
    choice,
    file_of,
    finite,
    number,
    whole,
)


@pytest.mark.parametrize("text", ["1", "9", "+3"])
def test_a_whole_number_within_its_limits_is_taken(text: str) -> None:
    assert whole(1, 9)(text) == int(text)


@pytest.mark.parametrize("text", ["0", "10", "1.0", "", "nine", "1e0", "9" * 5000])
def test_any_other_is_refused_with_what_was_expected(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="whole number from 1 to 9"):
        whole(1, 9)(text)


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "x", ""])
def test_numbers_are_finite(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="finite"):
        finite(text)


def test_a_number_of_ones_own_limits() -> None:
    share = number(lambda value: 0.0 <= value <= 1.0, "a share")
    assert share("0.25") == 0.25
    for text in ("1.01", "-0.01", "nan", "x"):
        with pytest.raises(argparse.ArgumentTypeError, match="a share"):
            share(text)


def test_one_of_some_words() -> None:
    assert choice("noisy", "ideal")("ideal") == "ideal"
    with pytest.raises(argparse.ArgumentTypeError, match="noisy, ideal"):
        choice("noisy", "ideal")("loud")


def test_a_parser_refuses_in_one_line_and_takes_numbers_below_zero() -> None:
    parser = Parser("./roomba thing", "", "")
    parser.add_argument("--at", type=finite, nargs=2)
    assert parser.parse_args(["--at", "-1e-05", "-.5"]).at == [-1e-05, -0.5]
    with pytest.raises(UsageError, match=r"--where; see ./roomba thing --help"):
        parser.parse_args(["--where"])


@pytest.mark.parametrize("words", [["--bag", "--help"], ["-h"], ["x", "--none", "--help"]])
def test_help_is_given_wherever_it_is_asked_for(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    parser = Parser("./roomba map", "Make a map.", "Lengths in m.")
    parser.add_argument("--bag", nargs="+", required=True)
    with pytest.raises(SystemExit) as ended:
        parser.parse_args(words)
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith("usage: ./roomba map")


def test_figures_go_to_standard_output_or_a_file() -> None:
    assert file_of("-") is None
    assert file_of(None) is None
    assert file_of("a.json") == Path("a.json")


def test_what_cannot_be_written_is_refused_before_the_work(tmp_path: Path) -> None:
    read = [("--map", tmp_path / "map.yaml")]
    check_written([("--json", tmp_path / "a.json"), ("--plot", tmp_path / "a.png")], read)
    for written, reason in (
        ([("--plot", tmp_path / "a.jpg")], "--plot: expected a name that ends with .png"),
        ([("--json", tmp_path)], "--json: expected a file in a folder that is there"),
        ([("--json", Path("/proc/a.json"))], "--json: expected a file that can be written"),
        ([("--json", tmp_path / "none" / "a")], "--json: expected a file in a folder"),
        (
            [("--json", tmp_path / "a"), ("--bag", tmp_path / "a")],
            "--bag: .* is the file of --json",
        ),
        ([("--json", tmp_path / "map.yaml")], "--json: .* is the file of --map"),
    ):
        with pytest.raises(UsageError, match=reason):
            check_written(written, read)


def test_a_configuration_that_is_not_there_is_refused(tmp_path: Path) -> None:
    check_config(None)
    with pytest.raises(UsageError, match=r"--config: expected a file like robot\.yaml"):
        check_config(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("roomba.commands.play.command", "--home --help"),
        ("roomba.commands.play.replay", "--speed --help"),
        ("roomba.commands.export.command", "--to --help"),
        ("roomba.commands.valetudo.export_command", "valetudo flat --out --help"),
        ("roomba.commands.report.command", "--out -h"),
        ("roomba.commands.status.command", "--home --help"),
        ("roomba.commands.top.command", "--home --help"),
    ],
)
def test_help_is_given_where_a_value_is_due(
    module: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        importlib.import_module(module).main(words.split())
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith("usage: ")
