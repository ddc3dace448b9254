"""The command from its file to its tables, with made-up runs: resumed, kept, told."""

from __future__ import annotations

import json
from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import pytest
from fixtures.campaigns.campaign_work import FINE
from pyarrow import parquet

from roomba.commands.campaign import command, plot
from roomba.commands.campaign import parquet as written
from roomba.commands.campaign.running import machines
from roomba.commands.campaign.running.machines import Machines
from roomba.commands.campaign.running.runs import CampaignRun
from roomba.commands.campaign.running.work import RunEnd
from roomba.errors import RoombaError
from roomba.history.database import History

TEXT = """
homes: [studio, flat]
seeds: {first: 0, count: 3}
variants:
  usual: {}
  longer: {passes: 2}
"""


class MadeRuns:
    """Stands for the machines: notes what they were asked for, and ends what it likes."""

    def __init__(self) -> None:
        self.asked: list[CampaignRun] = []
        self.ends_after: int | None = None
        self.with_what: BaseException = KeyboardInterrupt()
        self.lost: set[int] = set()
        self.failing: set[int] = set()

    def __call__(
        self, where: Machines, runs: Sequence[CampaignRun]
    ) -> Generator[tuple[CampaignRun, RunEnd | str]]:
        for done, run in enumerate(runs):
            if done == self.ends_after:
                raise self.with_what
            self.asked.append(run)
            yield run, self._end_of(run)

    def _end_of(self, run: CampaignRun) -> RunEnd | str:
        if run.seed in self.lost:
            return "its process ended (status 7)"
        if run.seed in self.failing:
            return RunEnd(None, "no floor", "here:1", 1000.0)
        longer = 5.0 + 0.1 * run.seed if run.variant == "longer" else 0.0
        figures = replace(FINE, distance_m=30.0 + run.seed + longer, hits=run.seed)
        return RunEnd(figures, "", "here:1", 1000.0 + run.seed)


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> MadeRuns:
    made = MadeRuns()
    monkeypatch.setattr(machines, "run_on", made)
    return made


@pytest.fixture
def made(drawn: MadeRuns, monkeypatch: pytest.MonkeyPatch) -> MadeRuns:
    """The same for who looks at no picture: to draw it takes longer than all else."""
    monkeypatch.setattr(plot, "write_plot", lambda *_: None)
    return drawn


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROOMBA_HISTORY", str(tmp_path / "history"))
    path = tmp_path / "made.yaml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_variants_are_told_beside_the_baseline(
    drawn: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main([str(file)]) == 0
    told = capsys.readouterr()
    assert len(drawn.asked) == 12
    assert "longer less usual" in told.out
    (line,) = (line for line in told.out.splitlines() if "distance, m" in line and "all" in line)
    assert line.split()[2:] == ["all", "6", "+5.10", "+5.01", "+5.19", "differs"]
    picture = cv2.imread(str(file.with_suffix(".results") / "differences.png"))
    assert picture is not None
    assert picture.std() > 1.0


def test_json_has_the_runs_and_the_comparisons(
    made: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main([str(file), "--json", "--quiet"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["version"], told["baseline"], len(told["runs"])) == (1, "usual", 12)
    (distance,) = (
        each
        for each in told["comparisons"]
        if each["measure"] == "distance_m" and each["home"] == "flat"
    )
    assert (distance["pairs"], distance["variant"]) == (3, "longer")
    assert distance["difference"] == pytest.approx(5.1)


def test_what_was_stored_is_not_asked_for_again(
    made: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made.ends_after = 5
    assert command.main([str(file)]) == 130
    assert "stopped on the way; the same command goes on" in capsys.readouterr().err
    assert parquet.read_table(file.with_suffix(".results") / "results.parquet").num_rows == 5
    made.ends_after = None
    assert command.main([str(file)]) == 0
    keys = [run.key for run in made.asked]
    assert len(keys) == len(set(keys)) == 12
    assert command.main([str(file)]) == 0
    assert len(made.asked) == 12


def test_a_cluster_that_is_gone_ends_it_and_what_was_stored_stays(
    made: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made.ends_after, made.with_what = 7, RoombaError("no scheduler")
    assert command.main([str(file)]) == 1
    assert "no scheduler" in capsys.readouterr().err
    made.ends_after = None
    assert command.main([str(file)]) == 0
    assert len(made.asked) == 12


def test_a_run_without_an_end_is_told_and_tried_again_by_the_next_call(
    made: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made.lost = {2}
    assert command.main([str(file)]) == 1
    assert "studio, seed 2, usual" in capsys.readouterr().out
    made.lost = set()
    assert command.main([str(file)]) == 0
    assert len(made.asked) == 16


def test_a_run_that_would_fail_anywhere_is_told_and_not_tried_again(
    made: MadeRuns, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made.failing = {1}
    assert command.main([str(file)]) == 1
    assert "no floor" in capsys.readouterr().out
    assert command.main([str(file)]) == 1
    assert len(made.asked) == 12


def test_each_run_is_in_the_history_once(made: MadeRuns, file: Path, tmp_path: Path) -> None:
    made.ends_after = 3
    command.main([str(file), "--quiet"])
    made.ends_after = None
    command.main([str(file), "--quiet"])
    command.main([str(file), "--quiet"])
    runs = [kept.figures for kept in History(tmp_path / "history").runs()]
    assert len(runs) == 12
    longer = next(run for run in runs if run.source.configuration["variant"] == "longer")
    assert longer.source.program == "campaign"
    assert longer.source.configuration["passes"] == 2
    assert longer.source.repeat == f"./roomba campaign {file} --quiet"
    assert longer.distance == pytest.approx(35.0 + 1.1 * (longer.source.seed or 0))
    assert longer.outcome == "completed"


def test_no_history_keeps_nothing_there(made: MadeRuns, file: Path, tmp_path: Path) -> None:
    assert command.main([str(file), "--quiet", "--no-history"]) == 0
    assert not (tmp_path / "history").exists()


def test_parquet_has_a_typed_row_for_each_run(made: MadeRuns, file: Path) -> None:
    made.failing = {1}
    command.main([str(file), "--quiet"])
    table = parquet.read_table(file.with_suffix(".results") / "results.parquet")
    rows = table.to_pylist()
    assert len(rows) == 12
    assert str(table.schema.field("distance_m").type) == "double"
    assert str(table.schema.field("seed").type) == "int64"
    fine = next(row for row in rows if row["seed"] == 2 and row["variant"] == "usual")
    assert (fine["distance_m"], fine["hits"], fine["where"]) == (32.0, 2, "here:1")
    failed = next(row for row in rows if row["seed"] == 1)
    assert (failed["distance_m"], failed["failure"]) == (None, "no floor")
    assert table.schema.metadata[b"baseline"] == b"usual"


def test_without_pyarrow_all_else_is_there_and_it_is_told(
    made: MadeRuns,
    file: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(written, "why_no_parquet", lambda: "No module named 'pyarrow'")
    assert command.main([str(file)]) == 0
    assert "pip install 'roomba_robot[campaign]'" in capsys.readouterr().err
    assert not (file.with_suffix(".results") / "results.parquet").exists()


@pytest.mark.parametrize(
    ("words", "text", "said"),
    [
        ("no.yaml", TEXT, "expected the file of a campaign, got no.yaml"),
        ("{} --cluster here", TEXT, "--cluster: expected local:N"),
        ("{} --cluster local:2 --processes 2", TEXT, "got both"),
        ("{} --processes 0", TEXT, "expected a whole number from 1"),
        ("{} --plot a.gif", TEXT, "expected a name that ends with .png"),
        ("{} --out {}", TEXT, "--out: expected a folder"),
        ("{}", TEXT.replace("flat", "castle"), "got 'castle'"),
        ("{}", TEXT.replace("passes: 2", "numbers: {mission.a: 1}"), "variant longer: numbers"),
        ("{}", TEXT.replace("passes: 2", "stages: {order: gone:f}"), "variant longer: stages"),
        ("{}", TEXT.replace("usual: {}", "usual: 3"), "variants.usual"),
    ],
)
def test_wrong_usage_is_status_2_and_one_line(
    made: MadeRuns,
    file: Path,
    capsys: pytest.CaptureFixture[str],
    words: str,
    text: str,
    said: str,
) -> None:
    file.write_text(text, encoding="utf-8")
    assert command.main([word.replace("{}", str(file)) for word in words.split()]) == 2
    told = capsys.readouterr()
    assert said in told.err
    assert len(told.err.splitlines()) == 1
    assert made.asked == []
