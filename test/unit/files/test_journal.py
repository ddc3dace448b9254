"""Lines of a journal reach the disk one by one; a line that is cut short costs no other line."""

from __future__ import annotations

import os
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.journal import append_line, read_lines


def written(path: Path, count: int = 3) -> bytes:
    for number in range(count):
        append_line(path, {"number": number, "name": "Küche\n"})
    return path.read_bytes()


def numbers(path: Path) -> list[int]:
    return [line["number"] for line in read_lines(path)]


def test_lines_come_back_in_order(tmp_path: Path) -> None:
    path = tmp_path / "runs.journal"
    assert read_lines(path) == []
    written(path)
    assert read_lines(path) == [{"number": n, "name": "Küche\n"} for n in range(3)]
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_line_is_on_the_disk_once_it_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, synced = tmp_path / "runs.journal", list[bytes]()
    monkeypatch.setattr(os, "fsync", lambda _: synced.append(path.read_bytes()))
    whole = written(path, 1)
    assert synced == [whole]


@given(st.integers(1, 200))
def test_what_was_cut_short_costs_itself_alone(cut: int) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "runs.journal"
        whole = written(path)
        path.write_bytes(whole[: max(0, len(whole) - cut)])
        left = numbers(path)
        assert left == list(range(len(left)))
        append_line(path, {"number": 9})
        assert numbers(path) == [*left, 9]


def test_a_damaged_line_is_skipped(tmp_path: Path) -> None:
    path = tmp_path / "runs.journal"
    whole = written(path)
    path.write_bytes(whole.replace(b'"number": 1', b'"number": 7'))
    assert numbers(path) == [0, 2]
    path.write_bytes(b"\xff\x00\n" + whole)
    assert numbers(path) == [0, 1, 2]


def test_what_json_does_not_have_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "runs.journal"
    with pytest.raises(ValueError, match="JSON compliant"):
        append_line(path, {"x": float("nan")})
    assert not path.exists()
