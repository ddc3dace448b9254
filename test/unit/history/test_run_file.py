"""Runs as files."""

from __future__ import annotations

import io
import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from roomba.history.replay import RecordedRobot
from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_file import RunFileError, packed, read_run, unpacked, write_run


def test_a_run_is_read_back(tmp_path: Path, figures: RunFigures, recording: RunRecording) -> None:
    path = tmp_path / "one.run"
    write_run(figures, recording, path)
    read, recorded = read_run(path)
    assert read.missed == figures.missed
    assert read.open_edges == figures.open_edges
    assert read.source == figures.source
    assert np.array_equal(recorded.trace, recording.trace)
    assert recorded.words == recording.words
    assert path.stat().st_mode & 0o777 == 0o600
    assert path.stat().st_size < 20_000


@pytest.mark.parametrize("content", [b"", b"no run", b"PK\x03\x04 broken"])
def test_what_is_no_run_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "other.run"
    path.write_bytes(content)
    with pytest.raises(RunFileError, match=r"other\.run: expected"):
        read_run(path)


def test_half_a_file_and_another_version_are_refused(
    tmp_path: Path, figures: RunFigures, recording: RunRecording
) -> None:
    content = packed(figures, recording)
    path = tmp_path / "half.run"
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(RunFileError, match="expected"):
        read_run(path)
    with np.load(io.BytesIO(content)) as arrays:
        changed = dict(arrays)
    about = changed["about"].tobytes().replace(b'"version": 1', b'"version": 9', 1)
    changed["about"] = np.frombuffer(about, np.uint8)
    with open(path, "wb") as file:
        np.savez(file, **changed)
    with pytest.raises(RunFileError, match="version 9"):
        read_run(path)
    with pytest.raises(RunFileError, match="cannot be read"):
        read_run(tmp_path / "none.run")


def changed(content: bytes, **about: object) -> bytes:
    """Return a run of which it is told something else."""
    with np.load(io.BytesIO(content)) as arrays:
        found = dict(arrays)
    values = {**json.loads(found["about"].tobytes()), **about}
    found["about"] = np.frombuffer(json.dumps(values).encode(), np.uint8)
    file = io.BytesIO()
    np.savez(file, **found)
    return file.getvalue()


@pytest.mark.parametrize(
    "about",
    [
        {"words": [{"time": "noon", "state": "docked", "phase": "docked"}]},
        {"words": [{"time": 1.0, "state": ["docked"], "phase": "docked"}]},
        {"words": [1]},
        {"words": None},
        {"figures": {"kind": "clean"}},
        {"figures": [1]},
        {"home": [1]},
        {"home": None},
        {"layers": {"map": ["a", "b", "c"]}},
        {"layers": {"map": [0.05]}},
    ],
    ids=str,
)
def test_values_of_another_kind_are_refused(
    figures: RunFigures, recording: RunRecording, about: dict[str, object]
) -> None:
    content = packed(figures, recording)
    assert unpacked(changed(content))[1].words == recording.words
    with pytest.raises(RunFileError, match="damaged, or something else"):
        unpacked(changed(content, **about))


def test_what_nests_deeply_or_is_no_regular_file_is_refused(tmp_path: Path) -> None:
    file = io.BytesIO()
    np.savez(file, about=np.frombuffer(b"[" * 100_000, np.uint8), trace=np.zeros((1, 1)))
    with pytest.raises(RunFileError, match="damaged, or something else"):
        unpacked(file.getvalue())
    pipe = tmp_path / "pipe.run"
    os.mkfifo(pipe)
    with pytest.raises(RunFileError, match="cannot be read"):
        read_run(pipe)


@pytest.mark.parametrize("home", [{}, {"name": "box"}, {"version": "x"}, {"rooms": 3}])
def test_a_home_that_cannot_be_shown_is_refused(
    figures: RunFigures, recording: RunRecording, home: dict[str, object]
) -> None:
    with pytest.raises(RunFileError, match="with the home that it is of"):
        RecordedRobot(figures, replace(recording, home=home))


def test_what_could_not_be_read_again_is_not_written(
    tmp_path: Path, figures: RunFigures, recording: RunRecording
) -> None:
    trace = recording.trace.copy()
    trace[0, 1] = np.nan
    with pytest.raises(RunFileError, match="finite"):
        write_run(figures, replace(recording, trace=trace), tmp_path / "one.run")
    with pytest.raises(RunFileError, match="finite"):
        write_run(figures, replace(recording, home={"radius": np.inf}), tmp_path / "one.run")
    with pytest.raises(RunFileError, match="plain"):
        write_run(figures, replace(recording, home={"rooms": {1}}), tmp_path / "one.run")
    assert not list(tmp_path.iterdir())
