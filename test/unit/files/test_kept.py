"""A kept file is sealed; a damaged one is set aside and reported, and the earlier one is used."""

from __future__ import annotations

import errno
import io
import os
import re
from pathlib import Path

import numpy as np
import PIL.Image
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.bounded import read_bytes
from roomba.files.kept import (
    KeptFileError,
    SealError,
    UnreadFileError,
    before_of,
    read_kept,
    remove_kept,
    sealed,
    unsealed,
    write_kept,
)

PGM = b"P5\n2 1\n255\n\x00\xfe"


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def read(path: Path) -> bytes | None:
    return read_kept(path, bytes, pytest.fail)


def archive() -> bytes:
    packed = io.BytesIO()
    np.savez(packed, numbers=np.arange(3.0))
    return packed.getvalue()


@given(st.one_of(st.binary(max_size=300), st.just(PGM), st.just(archive())), st.integers(0, 10**8))
def test_what_is_sealed_comes_back(content: bytes, version: int) -> None:
    content, found = unsealed(content, 10**9), sealed(content, version)
    assert unsealed(found, version) == content
    assert sealed(found, version) == found
    if version:
        with pytest.raises(SealError, match="newer program"):
            unsealed(found, version - 1)


@pytest.mark.parametrize(
    "content", [b"name: hall\n", PGM, archive(), b'{"run": 1}', b"P5 2 1 255 "]
)
def test_no_byte_that_is_sealed_can_change_unnoticed(content: bytes) -> None:
    found = sealed(content)
    seal = found.index(b"# kept")
    for at in range(len(found)):
        if seal <= at < seal + len(found) - len(content):
            continue
        with pytest.raises(SealError, match="checksum"):
            unsealed(found[:at] + bytes([found[at] ^ 0x10]) + found[at + 1 :])


def test_other_programs_take_no_notice_of_a_seal() -> None:
    assert yaml.safe_load(sealed(b"name: hall\n")) == {"name": "hall"}
    with np.load(io.BytesIO(sealed(archive()))) as file:
        assert file["numbers"].tolist() == [0.0, 1.0, 2.0]
    with PIL.Image.open(io.BytesIO(sealed(PGM))) as picture:
        assert (picture.size, picture.tobytes()) == ((2, 1), b"\x00\xfe")


def test_a_file_without_a_seal_is_read_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "old.yaml"
    assert read(path) is None
    path.write_bytes(b"name: hall\n")
    assert read(path) == b"name: hall\n"
    write_kept(path, b"name: kitchen\n")
    assert before_of(path).read_bytes() == b"name: hall\n"
    assert read(path) == b"name: kitchen\n"


def damaged(path: Path, how: str) -> None:
    content = path.read_bytes()
    match how:
        case "flipped":
            path.write_bytes(content[:-2] + bytes([content[-2] ^ 1]) + content[-1:])
        case "cut":
            path.write_bytes(content[:-3])
        case "empty":
            path.write_bytes(b"")
        case "a pipe":
            path.unlink()
            os.mkfifo(path)
        case "a folder":
            path.unlink()
            path.mkdir()


def parsed(content: bytes) -> bytes:
    if not content:
        raise ValueError("expected something, got nothing")
    return content


HOW = ("flipped", "cut", "empty", "a pipe", "a folder")


@pytest.mark.parametrize("how", HOW)
def test_a_damaged_file_is_set_aside_and_the_one_before_is_used(tmp_path: Path, how: str) -> None:
    path, told = tmp_path / "map.yaml", list[str]()
    for number in range(3):
        write_kept(path, b"number: %d\n" % number)
    damaged(path, how)
    assert read_kept(path, parsed, told.append) == b"number: 1\n"
    (line,) = told
    assert f"{path}: " in line
    assert "it is set aside as map.yaml.damaged; the one from before is used" in line
    assert names(tmp_path) == ["map.yaml", "map.yaml.before", "map.yaml.damaged"]
    assert read(path) == b"number: 1\n"


@pytest.mark.parametrize("how", HOW)
def test_without_one_before_it_is_an_error(tmp_path: Path, how: str) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    damaged(path, how)
    with pytest.raises(KeptFileError, match=r"map\.yaml: .*set aside as map\.yaml\.damaged"):
        read_kept(path, parsed, pytest.fail)
    assert names(tmp_path) == ["map.yaml.damaged"]
    assert read(path) is None


def test_when_both_are_damaged_both_are_told(tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    damaged(path, "flipped")
    damaged(before_of(path), "cut")
    with pytest.raises(KeptFileError, match=r"set aside.*; neither can map\.yaml\.before be used"):
        read_kept(path, parsed, pytest.fail)
    assert names(tmp_path) == ["map.yaml.before.damaged", "map.yaml.damaged"]


@pytest.mark.parametrize("how", HOW)
def test_a_damaged_file_does_not_become_the_one_before(tmp_path: Path, how: str) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    damaged(path, how)
    write_kept(path, b"number: 3\n")
    damaged(path, how)
    assert read_kept(path, parsed, lambda _: None) == b"number: 1\n"


def refuse(*_: object, **__: object) -> None:
    raise PermissionError(1, "Operation not permitted")


def test_a_file_system_without_hard_links_has_a_copy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "link", refuse)
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    damaged(path, "flipped")
    assert read_kept(path, parsed, lambda _: None) == b"number: 1\n"


@pytest.mark.parametrize("call", ["link", "replace", "fsync"])
def test_a_writer_that_is_stopped_leaves_the_file_from_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")

    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, call, stopped)
    with pytest.raises(KeyboardInterrupt):
        write_kept(path, b"number: 3\n")
    monkeypatch.undo()
    assert read(path) == b"number: 2\n"
    assert read(before_of(path)) in (b"number: 1\n", b"number: 2\n")


@pytest.mark.parametrize("when", ["now", "before"])
@pytest.mark.parametrize("number", [errno.EMFILE, errno.EACCES, errno.EIO])
def test_what_the_disk_refuses_is_left_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, when: str, number: int
) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    if when == "before":
        damaged(path, "cut")
    refused, whole = path if when == "now" else before_of(path), names(tmp_path)

    def read(path: Path, most: int) -> bytes:
        if path == refused:
            raise OSError(number, os.strerror(number), str(path))
        return read_bytes(path, most)

    monkeypatch.setattr("roomba.files.kept.read_bytes", read)
    with pytest.raises(UnreadFileError, match=f"{refused.name}: expected a file that can be read"):
        read_kept(path, parsed, pytest.fail)
    assert names(tmp_path) == whole
    monkeypatch.undo()
    assert read_kept(path, parsed, lambda _: None) == b"number: %d\n" % (2 if when == "now" else 1)


def test_what_cannot_be_read_or_is_newer_is_set_aside_and_not_written_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(path: Path, most: int) -> bytes:
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), str(path))

    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n", 99)
    newer = path.read_bytes()
    write_kept(path, b"number: 2\n")
    assert path.with_name("map.yaml.damaged").read_bytes() == newer
    assert read_kept(path, parsed, pytest.fail) == b"number: 2\n"
    before = path.read_bytes()
    with monkeypatch.context() as refused:
        refused.setattr("roomba.files.kept.read_bytes", read)
        write_kept(path, b"number: 3\n")
    assert path.with_name("map.yaml.damaged").read_bytes() == before
    assert read_kept(path, parsed, pytest.fail) == b"number: 3\n"


def test_a_file_of_a_newer_program_is_left_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n", 99)
    with pytest.raises(UnreadFileError, match=r"which a newer program wrote; start that one, or"):
        read_kept(path, parsed, pytest.fail)
    assert names(tmp_path) == ["map.yaml", "map.yaml.before"]
    assert read_kept(path, parsed, pytest.fail, version=99) == b"number: 2\n"


@pytest.mark.parametrize("how", ["flipped", "cut", "empty"])
@pytest.mark.parametrize("refused", [1, 2])
def test_a_recovery_that_is_cut_short_is_done_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str, refused: int
) -> None:
    path, calls = tmp_path / "map.yaml", list[str]()
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    damaged(path, how)

    def write(path: Path, content: bytes) -> None:
        calls.append(path.name)
        if len(calls) >= refused:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        path.write_bytes(content)

    monkeypatch.setattr(os, "link", refuse)
    monkeypatch.setattr("roomba.files.kept.write_whole", write)
    assert read_kept(path, parsed, lambda _: None) == b"number: 1\n"
    monkeypatch.undo()
    assert read_kept(path, parsed, lambda _: None) == b"number: 1\n"
    assert read(path) == b"number: 1\n"


def test_a_write_that_is_refused_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.yaml"
    write_kept(path, b"number: 1\n")
    write_kept(path, b"number: 2\n")
    monkeypatch.setattr("roomba.files.kept.write_whole", refuse)
    for _ in range(3):
        with pytest.raises(PermissionError):
            write_kept(path, b"number: 3\n")
    assert names(tmp_path) == ["map.yaml", "map.yaml.before"]


@pytest.mark.parametrize("has_links", [False, True])
def test_what_is_written_can_be_read_again_however_large(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, has_links: bool
) -> None:
    # All that reads the file for itself is to read as much.
    monkeypatch.setattr(read_bytes, "__defaults__", (100,))
    if not has_links:
        monkeypatch.setattr(os, "link", refuse)
    path = tmp_path / "large"
    for content in (b"a" * 900, b"b" * 900):
        write_kept(path, content, most=1000)
    with pytest.raises(OSError, match="expected at most 1000 bytes, got 1081"):
        write_kept(path, b"c" * 1000, most=1000)
    assert read_kept(path, bytes, pytest.fail, most=1000) == b"b" * 900
    damaged(path, "flipped")
    told = list[str]()
    assert read_kept(path, bytes, told.append, most=1000) == b"a" * 900
    assert len(told) == 1


def test_a_file_is_forgotten_with_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "errand.json"
    write_kept(path, b"1")
    write_kept(path, b"2")
    remove_kept(path)
    assert names(tmp_path) == []
    remove_kept(path)


WITHOUT_SEAL: dict[str, str] = {
    "roomba/commands/campaign/parquet.py": "made for the user, by a command",
    "roomba/commands/service.py": "a unit of systemd",
    "roomba/commands/valetudo/homes.py": "made for the user, by a command",
    "roomba/files/journal.py": "each line has a checksum",
    "roomba/files/kept.py": "seals",
    "roomba/storage/pictures_folder.py": "a picture that is damaged is taken again",
    "roomba/ui/pictures.py": "made for the user, by the menu",
    "roomba/ui/web/kept_token.py": "one of another form is replaced",
}
"""Modules that write files whole without a seal, and why that is enough."""


OPENED: dict[str, str] = {
    "roomba_ros/model/picture.py": "made for the user, by a command",
    "roomba_ros/supervision/launch_file.py": "a pipe to a process",
    "roomba_ros/supervision/namespace.py": "files of the kernel",
}
"""Modules that write in another way."""
SOURCE = Path(__file__).parents[3] / "src"
THE_ROBOTS = ("storage", "history", "household", "plans", "upkeep", "mission", "perception")


def found(pattern: str, *folders: Path) -> set[str]:
    """Return the modules in folders in which there is something like a pattern."""
    return {
        str(path.relative_to(SOURCE))
        for folder in folders
        for path in folder.rglob("*.py")
        if re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    }


def test_all_that_the_robot_keeps_is_sealed() -> None:
    whole = r"^from roomba\.files\.atomic import .*\bwrite_whole\b"
    assert found(whole, SOURCE) == set(WITHOUT_SEAL)
    opened = r"\.write_(bytes|text)\(|\bopen\([^)]*\"[wax]b?\""
    robots = [SOURCE / "roomba" / name for name in THE_ROBOTS]
    assert found(opened, SOURCE / "roomba_ros", *robots) == set(OPENED)
