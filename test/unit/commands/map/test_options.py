"""What may be asked of ``./roomba map``, and what is refused before anything is done."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.commands.map.options import options_of
from roomba.commands.options import UsageError
from roomba.geometry import Pose


def test_without_words_the_flat_is_explored() -> None:
    options = options_of([])
    assert options.trial.home == "flat"
    assert options.trial.seed == 0
    assert options.output.json is None
    assert options.output.plot is None
    assert options.output.out is None


def test_all_words_are_understood(tmp_path: Path) -> None:
    some = tmp_path / "some.yaml"
    some.write_text("", encoding="utf-8")
    words = f"--map {some} --station 1 -2.5 -1e-3 --seed 7 --sensors ideal --json {tmp_path}/a"
    words += f" --plot {tmp_path}/b.png --out {tmp_path}/new --quiet --turned 45 --lidar ld19"
    options = options_of(words.split())
    assert options.trial.home == str(some)
    assert options.trial.station == Pose(1.0, -2.5, -0.001)
    assert (options.trial.seed, options.trial.sensors) == (7, "ideal")
    assert (options.trial.turned, options.trial.lidar) == (45.0, "ld19")
    assert options.output.json == f"{tmp_path}/a"
    assert options.output.plot == tmp_path / "b.png"
    assert options.output.out == tmp_path / "new"
    assert options.output.quiet


def test_json_alone_is_standard_output() -> None:
    assert options_of(["--json"]).output.json == "-"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--home flat --map x.yaml", "expected --home or --map, got both"),
        ("--seed -1", "expected a whole number from 0 to"),
        ("--seed 1.5", "got '1.5'"),
        ("--station 1 2", "expected 3 arguments"),
        ("--station 1 2 nan", "expected finite numbers"),
        ("--plot picture.jpg", "expected a name that ends with .png"),
        ("--plot nowhere/picture.png", "expected a file in a folder that is there"),
        ("--json nowhere/file", "expected a file in a folder that is there"),
        ("--out nowhere/at/all", "expected a folder, or a new one"),
        ("--config nowhere.yaml", "expected a file like robot.yaml"),
        ("--json a.png --plot a.png", "is the file of --json already"),
        ("--map nowhere.yaml", "--map: expected a file of a map_server map"),
        ("--sensors blind", "expected noisy, ideal, got 'blind'"),
        ("--lidar none", "expected ideal_12m, "),
        ("--nonsense", "unrecognized arguments"),
    ],
)
def test_what_cannot_be_obeyed_is_told(words: str, said: str) -> None:
    with pytest.raises(UsageError) as raised:
        options_of(words.split())
    assert said in str(raised.value)


def test_a_map_is_not_overwritten(tmp_path: Path) -> None:
    both = tmp_path / "map.png"
    both.write_bytes(b"")
    with pytest.raises(UsageError, match="is the file of --map already"):
        options_of(["--map", str(both), "--plot", str(both)])


def test_a_file_is_no_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(UsageError, match="expected a folder"):
        options_of(["--out", str(tmp_path / "file")])


def test_help_tells_of_bags(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        options_of(["--help"])
    assert ended.value.code == 0
    assert "--bag FILE:" in " ".join(capsys.readouterr().out.split())
