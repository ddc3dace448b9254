"""The same key means the same run: what decides about it changes it, and nothing else does."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fixtures.campaigns.campaign_work import made_run

from roomba.commands.campaign.running import work
from roomba.commands.campaign.running.runs import (
    CampaignRun,
    OtherMachineError,
    require_same,
    runs_of,
)
from roomba.commands.campaign.running.specification import read_campaign
from roomba.commands.campaign.running.work import RunEnd, carried_out
from roomba.commands.trials import runs as trials
from roomba.commands.trials import warm
from roomba.errors import HomeError
from roomba.files.shipped import HOMES

STAGE = "def swaths(left, middles, radius, config): return []\n"
TEXT = """
homes: [mine]
seeds: [1, 2]
variants:
  usual: {}
  same: {}
  worn: {wheels: worn}
  own: {stages: {swaths: stage_of_a_campaign:swaths}}
"""


def made(folder: Path) -> list[CampaignRun]:
    """Write a campaign with a home and a stage of its own, once, and return its runs."""
    if not (folder / "made.yaml").exists():
        shutil.copytree(HOMES / "studio", folder / "mine")
        (folder / "stage_of_a_campaign.py").write_text(STAGE, encoding="utf-8")
        (folder / "made.yaml").write_text(TEXT, encoding="utf-8")
    return runs_of(read_campaign(folder / "made.yaml"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all, as a stage's module is imported once."""
    return tmp_path_factory.mktemp("campaign")


def test_all_homes_seeds_and_variants_are_runs(folder: Path) -> None:
    runs = made(folder)
    assert [(run.seed, run.variant) for run in runs] == [
        (seed, name) for seed in (1, 2) for name in ("usual", "same", "worn", "own")
    ]
    keys = {(run.seed, run.variant): run.key for run in runs}
    assert keys[1, "usual"] == keys[1, "same"]
    assert len(set(keys.values())) == 6


def test_keys_are_the_same_every_time(folder: Path) -> None:
    assert [run.key for run in made(folder)] == [run.key for run in made(folder)]


@pytest.mark.parametrize("name", ["mine/home.yaml", "stage_of_a_campaign.py"])
def test_another_home_or_stage_is_another_run(folder: Path, name: str) -> None:
    before = {(run.seed, run.variant): run.key for run in made(folder)}
    file = folder / name
    content = file.read_text(encoding="utf-8")
    file.write_text(content + "\n", encoding="utf-8")
    try:
        after = {(run.seed, run.variant): run.key for run in made(folder)}
    finally:
        file.write_text(content, encoding="utf-8")
    changed = {variant for (_, variant), key in before.items() if key not in after.values()}
    assert changed == ({"own"} if name.endswith(".py") else {"usual", "same", "worn", "own"})


def test_a_map_with_another_picture_is_another_run_also_where_that_lies_elsewhere(
    tmp_path: Path,
) -> None:
    made(tmp_path)
    picture, map_file = tmp_path / "mine" / "map.pgm", tmp_path / "mine" / "map.yaml"
    outside = picture.rename(tmp_path / "map.pgm")
    map_file.write_text("image: ../map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n", "utf-8")
    before = {run.key for run in made(tmp_path)}
    outside.write_bytes((HOMES / "flat" / "map.pgm").read_bytes())
    assert not before & {run.key for run in made(tmp_path)}


def test_a_machine_with_the_same_program_and_files_takes_it(folder: Path) -> None:
    for run in made(folder):
        require_same(run)


def test_a_machine_with_another_program_refuses(folder: Path) -> None:
    run = replace(made(folder)[0], program="another")
    with pytest.raises(OtherMachineError, match="expected the program, numpy and numba"):
        carried_out(run)


def test_a_machine_with_another_home_refuses(folder: Path) -> None:
    run = replace(made(folder)[0], content="another")
    with pytest.raises(OtherMachineError, match="expected home mine"):
        require_same(run)


def test_a_machine_without_the_home_refuses(folder: Path) -> None:
    run = made(folder)[0]
    gone = replace(run, trial=replace(run.trial, home=str(folder / "gone")))
    with pytest.raises(OtherMachineError, match="gone"):
        require_same(gone)


@pytest.mark.parametrize(
    ("error", "is_an_end"),
    [
        (HomeError("no floor"), True),
        (IndexError("of a stage"), True),
        (MemoryError("no 37 MiB"), False),
        (OSError("the disk is full"), False),
    ],
)
def test_only_for_want_of_memory_or_disk_a_run_has_no_end(
    monkeypatch: pytest.MonkeyPatch, error: Exception, *, is_an_end: bool
) -> None:
    def failing(*_: Any) -> None:
        raise error

    monkeypatch.setattr(work, "require_same", lambda _: None)
    monkeypatch.setattr(warm, "warm_up", lambda: None)
    monkeypatch.setattr(trials, "run_trial", failing)
    end = carried_out(made_run(0))
    assert isinstance(end, RunEnd) is is_an_end
    assert str(error) in (end.failure if isinstance(end, RunEnd) else end)
