"""Files are written whole, or not at all."""

import os
from pathlib import Path

import pytest

from roomba.files.atomic import write_whole


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def test_a_file_and_its_folders_are_made_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "folder" / "map.json"
    write_whole(path, b"\x00old")
    assert path.read_bytes() == b"\x00old"
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert names(path.parent) == ["map.json"]


@pytest.mark.parametrize("call", ["fsync", "replace"])
@pytest.mark.parametrize("error", [OSError("no space left"), KeyboardInterrupt()])
def test_who_is_stopped_while_writing_leaves_the_file_from_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, error: BaseException
) -> None:
    path = tmp_path / "map.json"
    write_whole(path, b"old")

    def stopped(*_: object) -> None:
        raise error

    monkeypatch.setattr(os if call == "fsync" else Path, call, stopped)
    with pytest.raises(type(error)):
        write_whole(path, b"a longer new one")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["map.json"]


def test_all_of_it_is_on_the_disk_before_it_takes_the_others_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.json"
    write_whole(path, b"old")
    seen: list[tuple[bytes, int]] = []
    monkeypatch.setattr(
        os, "fsync", lambda file: seen.append((path.read_bytes(), os.fstat(file).st_size))
    )
    write_whole(path, b"longer")
    assert seen == [(b"old", 6)]


def test_files_that_differ_in_their_ending_do_not_meet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unfinished: list[str] = []
    monkeypatch.setattr(os, "fsync", lambda _: unfinished.extend(names(tmp_path)))
    for name in ("map.json", "map.npz"):
        write_whole(tmp_path / name, b"")
        (tmp_path / name).unlink()
    assert len(set(unfinished)) == 2


def test_a_folder_that_is_a_file_is_the_disks_refusal(tmp_path: Path) -> None:
    (tmp_path / "folder").write_text("", encoding="utf-8")
    with pytest.raises(OSError, match="folder"):
        write_whole(tmp_path / "folder" / "map.json", b"")
