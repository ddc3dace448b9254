"""Files that are read whole: regular ones, up to a size."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from roomba.files.bounded import read_bytes, read_text


def test_a_file_is_read_up_to_its_size(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    assert read_bytes(path, 5) == b"12345"
    with pytest.raises(OSError, match="expected at most 4 bytes, got 5"):
        read_bytes(path, 4)


def test_of_a_file_that_is_too_large_nothing_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file"
    with path.open("wb") as file:
        file.truncate(1 << 40)
    monkeypatch.setattr("builtins.open", unread)
    with pytest.raises(OSError, match="got 1099511627776"):
        read_bytes(path)


@contextlib.contextmanager
def unread(*_: object) -> Iterator[None]:
    """A file that cannot be read."""
    yield None


def test_a_file_that_says_no_size_is_read_up_to_the_limit_and_no_further() -> None:
    path = Path("/proc/self/status")
    assert path.stat().st_size == 0
    assert read_bytes(path)
    with pytest.raises(OSError, match="expected at most 4 bytes, got 5"):
        read_bytes(path, 4)


def test_text_is_utf_8(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes("Küche".encode())
    assert read_text(path) == "Küche"
    path.write_bytes("\ufeffKüche".encode())
    assert read_text(path) == "Küche"
    path.write_bytes(b"\xff")
    with pytest.raises(UnicodeDecodeError):
        read_text(path)


def test_what_is_no_regular_file_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path, kind in ((tmp_path / "pipe", "a pipe"), (Path("/dev/zero"), "a device")):
        with pytest.raises(OSError, match=f"expected a regular file, got {kind}"):
            read_bytes(path)
    assert read_bytes(Path("/dev/null")) == b""
    with pytest.raises(IsADirectoryError):
        read_bytes(tmp_path)
    with pytest.raises(FileNotFoundError):
        read_bytes(tmp_path / "none")
