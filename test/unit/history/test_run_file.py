"""Runs as files."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_file import RunFileError, packed, read_run, write_run


def test_a_run_is_read_back(tmp_path: Path, figures: RunFigures, recording: RunRecording) -> None:
    path = tmp_path / "one.run"
    write_run(figures, recording, path)
    read, recorded = read_run(path)
    assert read.missed == figures.missed
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
