"""The file of a campaign: what it means, and what is refused before the first run."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.commands.campaign.running.specification import read_campaign
from roomba.commands.options import UsageError
from roomba.errors import ConfigError, RoombaError
from roomba.vocabulary import FanLevel

GOOD = """
homes: [studio, flat]
seeds: {first: 3, count: 4}
variants:
  usual: {}
  worn: {wheels: worn, fan: quiet, passes: 2, numbers: {mission.coverage.turning: 2.0}}
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "made.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_it_says_what_the_runs_are(tmp_path: Path) -> None:
    campaign = read_campaign(written(tmp_path, GOOD))
    assert (campaign.name, campaign.folder, campaign.baseline) == ("made", tmp_path, "usual")
    assert campaign.file.all_seeds == (3, 4, 5, 6)
    assert campaign.file.count == 16
    trial = campaign.file.variants["worn"].trial("studio", 5, tmp_path)
    assert (trial.home, trial.seed, trial.wheels) == ("studio", 5, "worn")
    assert (trial.request.passes, trial.request.fan) == (2, FanLevel.QUIET)
    assert trial.numbers == (("mission.coverage.turning", 2.0),)
    assert trial.code is None


def test_seeds_may_be_a_list(tmp_path: Path) -> None:
    text = GOOD.replace("{first: 3, count: 4}", "[7, 1]")
    assert read_campaign(written(tmp_path, text)).file.all_seeds == (7, 1)


def test_homes_are_names_or_folders_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "map.yaml").touch()
    campaign = read_campaign(written(tmp_path, GOOD))
    assert campaign.place_of("random") == "random"
    assert campaign.place_of("studio") == "studio"
    assert campaign.place_of("mine") == str(tmp_path / "mine")
    with pytest.raises(UsageError, match=r"expected random, .*studio.*, got 'castle'"):
        campaign.place_of("castle")


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("homes: [studio, flat]", "homes: []", "homes: .*at least 1"),
        ("[studio, flat]", "[flat, flat]", "homes: expected each once"),
        ("count: 4", "count: 0", "seeds"),
        ("count: 4", "count: 4, count: 5", r"made.yaml:3: expected each key once, got 'count'"),
        ("usual: {}", "worn: {}", r"made.yaml:6: expected each key once, got 'worn' again"),
        (
            "first: 3",
            "first: 9223372036854775805",
            "seeds: expected .* at most 9223372036854775807",
        ),
        ("{first: 3, count: 4}", "{first: -3, count: 4}", "made.yaml: seeds.first: expected .*0"),
        ("{first: 3, count: 4}", "{first: 3}", "made.yaml: seeds.count: expected a value"),
        (
            "{first: 3, count: 4}",
            "{first: 3, cuont: 4}",
            "made.yaml: seeds.count: expected a value",
        ),
        ("{first: 3, count: 4}", "[7, -1]", "made.yaml: seeds.1: expected .*0, got -1"),
        ("{first: 3, count: 4}", "[true]", "made.yaml: seeds.0: expected a valid int.*got True"),
        ("{first: 3, count: 4}", "7", "made.yaml: seeds: expected keys and values"),
        ("turning: 2.0", "turning: []", "worn.numbers.mission.coverage.turning: expected"),
        ("count: 4", "count: 60000", "expected at most 100000 runs, got 240000"),
        ("usual: {}", "usual: {bin: 1.0e-9}", "usual.bin: expected .*1, got"),
        ("usual: {}", "usual: {empty_after: 1.0e+12}", "usual.empty_after: expected .*86400, got"),
        ("usual: {}", "usual: {speed: 1}", "speed"),
        ("usual: {}", "usual: {lidar: x1}", "lidar: expected .*, got 'x1'"),
        ("wheels: worn", "wheels: square", "wheels"),
        ("passes: 2", "passes: 99", "passes"),
        ("variants:", "baseline: ours\nvariants:", "baseline: expected one of usual, worn"),
        ("variants:", "measures: [beauty]\nvariants:", "measures: expected completed.*'beauty'"),
        ("variants:", "confidence: 1.0\nvariants:", "confidence"),
        ("mission.coverage.turning", "turning", "a name that begins with robot, simulation"),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, before: str, after: str, said: str) -> None:
    assert before in GOOD
    with pytest.raises(RoombaError, match=said) as told:
        read_campaign(written(tmp_path, GOOD.replace(before, after)))
    assert isinstance(told.value, ConfigError | UsageError)
