"""A run of the command is kept as what it was."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fixtures.homes.tiny_home import tiny_home

from roomba.commands.sim.command import main
from roomba.history.database import History
from roomba.history.folder import history_folder


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROOMBA_HISTORY", str(tmp_path / "history"))
    return history_folder()


def test_a_run_is_kept_as_the_json_tells_it(folder: Path, tmp_path: Path) -> None:
    told = tmp_path / "run.json"
    arguments = ["--home", "studio", "--seed", "3", "--quiet", "--json", str(told)]
    assert main(arguments) == 0
    run, history = json.loads(told.read_text()), History(folder)
    (kept,) = history.runs()
    figures = kept.figures
    assert figures.source.home == run["home"]
    assert figures.source.seed == 3
    assert "--home studio --seed 3" in figures.source.repeat
    assert figures.outcome == "completed"
    assert figures.covered == pytest.approx(run["covered_m2"], abs=1e-4)
    assert figures.wanted == pytest.approx(run["coverable_m2"], abs=1e-4)
    assert figures.distance == pytest.approx(run["distance_m"], abs=1e-4)
    assert figures.turning == pytest.approx(run["turning_rad"], abs=1e-4)
    assert figures.dirt == pytest.approx(run["dirt_g"], abs=1e-4)
    assert [miss.reason for miss in figures.missed] == [miss["reason"] for miss in run["missed"]]
    recording = history.recording(kept.number)
    path = np.array(run["trajectory"])
    assert recording.trace[:, 1:3] == pytest.approx(path[::5, 1:3], abs=1e-3)
    assert recording.column("covered")[-1] == pytest.approx(figures.covered, rel=0.1)
    assert recording.column("dirt").max() == pytest.approx(figures.dirt, rel=0.05)
    assert {"undocking", "cleaning", "docking"} <= {word.phase for word in recording.words}
    coverage = recording.layers["coverage"]
    swept = np.count_nonzero(coverage.cells) * coverage.resolution**2
    assert swept >= 0.95 * figures.covered
    assert (folder / "runs.sqlite").stat().st_size < 1_000_000


KEEPING = """
import sys
import roomba.commands.sim.kept_run, roomba.commands.sim.state_samples, roomba.headless.live.playing
print([name for name in ("roomba.world.camera.camera", "roomba.plans.plan") if name in sys.modules])
"""


def test_what_keeps_a_run_reads_neither_the_camera_nor_the_households_plans() -> None:
    """They would take a twentieth of a second after each table."""
    told = subprocess.run(
        [sys.executable, "-c", KEEPING], capture_output=True, text=True, check=True, timeout=60
    )
    assert told.stdout == "[]\n"


def test_a_run_is_not_kept_on_demand(folder: Path, tmp_path: Path) -> None:
    assert main(["--home", str(tiny_home(tmp_path)), "--quiet", "--no-history"]) == 0
    assert not folder.exists()


def test_a_history_that_cannot_be_used_does_not_spoil_the_run(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder.write_text("no folder")
    assert main(["--home", str(tiny_home(tmp_path)), "--quiet"]) == 0
    assert "not kept" in capsys.readouterr().err
