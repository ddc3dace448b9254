"""Stages by import path: an unsuitable one is refused at once, and its results are checked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from roomba.commands.options import UsageError
from roomba.commands.trials.runs import run_trial
from roomba.commands.trials.stages import StageError, files_of_stage, stages_of
from roomba.commands.trials.trial import Trial
from roomba.planning.coverage.stages import OUR_STAGES

MODULE = """
import numpy as np
ANSWER = 42
def nothing(left, middles, radius, config): return []
def text(left, middles, radius, config): return "no lines"
def whole(left, middles, radius, config): return [np.zeros((2, 2), np.int64)]
def wild(*arguments): return np.array([(0.0, np.nan)])
def breaks(*arguments): return {}["no such key"]
def leaves(*arguments): raise SystemExit(0)
"""


@pytest.fixture(scope="session")
def code(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder for all, as a process imports a module once."""
    folder = tmp_path_factory.mktemp("code")
    (folder / "made_stages.py").write_text(MODULE, encoding="utf-8")
    return folder


def given(stage: Any) -> Any:
    return stage(None, None, 1.0, None)


def test_without_any_they_are_ours() -> None:
    assert stages_of(()) is OUR_STAGES


def test_one_of_a_folder_takes_the_place_of_ours(code: Path) -> None:
    stages = stages_of([("swaths", "made_stages:nothing")], code)
    assert given(stages.swaths) == []
    assert stages.order is OUR_STAGES.order
    files = files_of_stage("swaths", "made_stages:nothing", code)
    assert files == {"made_stages.py": code / "made_stages.py"}


def test_the_files_of_a_stage_are_those_that_it_imports_too(code: Path) -> None:
    (code / "stages_by_others.py").write_text("import numpy\nimport other_file\nf = other_file.f\n")
    (code / "other_file.py").write_text("from a_package.inner import f\n")
    (code / "a_package").mkdir()
    (code / "a_package/__init__.py").write_text("")
    (code / "a_package/inner.py").write_text("def f(*a): return []\n")
    (code / "not_imported.py").write_text("")
    files = files_of_stage("swaths", "stages_by_others:f", code)
    assert sorted(files) == [
        "a_package/__init__.py", "a_package/inner.py", "other_file.py", "stages_by_others.py",
    ]  # fmt: skip
    assert all(path == code / name for name, path in files.items())


def test_an_order_of_nothing_is_refused(code: Path) -> None:
    piece = np.zeros((2, 2))
    order: Any = stages_of([("order", "made_stages:nothing")], code).order
    with pytest.raises(StageError, match="expected the 2 pieces in some order, got none"):
        order([piece, piece], (0.0, 0.0), 1.0, None)


@pytest.mark.parametrize(
    ("name", "path", "said"),
    [
        (
            "swath",
            "made_stages:nothing",
            "expected edges, swaths, order, connection, polish, rounding",
        ),
        ("swaths", "made_stages", "expected MODULE:FUNCTION, got 'made_stages'"),
        ("swaths", "no_such_module:f", "a module that can be imported, got 'no_such_module'"),
        ("swaths", "made_stages:bogus", "expected a function, got none at 'made_stages:bogus'"),
        ("swaths", "made_stages:ANSWER", "expected a function"),
    ],
)
def test_what_is_no_stage_is_refused(code: Path, name: str, path: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        stages_of([(name, path)], code)


@pytest.mark.parametrize(
    ("name", "source"),
    [("stages_that_leave", "raise SystemExit(7)"), ("stages_that_break", "1 / 0")],
)
def test_a_module_that_ends_or_fails_as_it_is_imported_is_refused(
    code: Path, name: str, source: str
) -> None:
    (code / f"{name}.py").write_text(f"{source}\n", encoding="utf-8")
    with pytest.raises(UsageError, match=f"a module that can be imported, got '{name}'"):
        stages_of([("swaths", f"{name}:f")], code)


@pytest.mark.parametrize(
    ("name", "function", "said"),
    [
        ("swaths", "text", "a list of arrays.*got str"),
        ("swaths", "whole", "a list.*got a list with int64 of shape"),
        ("polish", "wild", "an array.*got float64 of shape"),
    ],
)
def test_what_the_next_stage_cannot_take_is_told(
    code: Path, name: str, function: str, said: str
) -> None:
    stages = stages_of([(name, f"made_stages:{function}")], code)
    with pytest.raises(StageError, match=f"made_stages:{function}: expected {said}"):
        given(getattr(stages, name))


@pytest.mark.parametrize(
    ("function", "said"),
    [("breaks", r"KeyError\('no such key'\)"), ("leaves", r"SystemExit\(0\)")],
)
def test_a_stage_that_fails_or_ends_the_program_is_told_with_its_line(
    code: Path, function: str, said: str
) -> None:
    line = 1 + MODULE.splitlines().index(next(x for x in MODULE.splitlines() if function in x))
    stages = stages_of([("swaths", f"made_stages:{function}")], code)
    with pytest.raises(StageError, match=rf"made_stages:{function}: {said} \(.*, line {line}\)"):
        given(stages.swaths)


def test_a_module_of_the_folder_comes_before_one_of_the_same_name(
    code: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "stages_there_twice.py").write_text("def f(*a): return ['of another folder']\n")
    (code / "stages_there_twice.py").write_text("def f(*a): return []\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert given(stages_of([("swaths", "stages_there_twice:f")], code).swaths) == []


def test_a_run_is_made_by_them() -> None:
    examples = Path(__file__).resolve().parents[4] / "examples" / "campaign"
    usual = Trial(home="studio", seed=1, sensors="ideal")
    own = Trial(
        home="studio",
        seed=1,
        sensors="ideal",
        stages=(("order", "nearest_next:order"),),
        code=examples,
    )
    ours, theirs = (run_trial(trial).figures for trial in (usual, own))
    assert theirs.is_completed
    assert theirs.fraction > 0.98
    assert theirs.distance_m > 1.02 * ours.distance_m
    assert np.isfinite(theirs.turning_rad)
