"""Files are written whole, or not at all."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from roomba.files.atomic import write_output, write_whole


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
def test_a_writer_that_is_stopped_leaves_the_file_from_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str, error: BaseException
) -> None:
    path = tmp_path / "map.json"
    write_whole(path, b"old")

    def stopped(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(os, call, stopped)
    with pytest.raises(type(error)):
        write_whole(path, b"a longer new one")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["map.json"]


def test_the_content_is_on_the_disk_before_it_takes_the_place_and_the_folder_after(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.json"
    write_whole(path, b"old")
    synced: list[tuple[bytes, bytes | Path]] = []

    def fsync(descriptor: int) -> None:
        place = Path(f"/proc/self/fd/{descriptor}").resolve()
        synced.append((path.read_bytes(), place if place.is_dir() else place.read_bytes()))

    monkeypatch.setattr(os, "fsync", fsync)
    write_whole(path, b"longer")
    assert synced == [(b"old", b"longer"), (b"longer", tmp_path)]


def test_only_the_owner_may_read_it(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    path.write_bytes(b"old")
    path.chmod(0o666)
    write_whole(path, b"new")
    assert path.stat().st_mode & 0o777 == 0o600


def test_folders_that_it_makes_are_the_owner_s_alone_and_others_stay(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir(0o755)
    shared.chmod(0o755)
    write_whole(shared / "home" / "maps" / "map.json", b"new")
    modes = [
        folder.stat().st_mode & 0o777
        for folder in (shared, shared / "home", shared / "home" / "maps")
    ]
    assert modes == [0o755, 0o700, 0o700]


def test_a_link_in_the_place_is_replaced_and_not_followed(tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.write_bytes(b"not to be touched")
    folder = tmp_path / "maps"
    folder.mkdir()
    (folder / "map.json").symlink_to(elsewhere)
    write_whole(folder / "map.json", b"new")
    assert elsewhere.read_bytes() == b"not to be touched"
    assert not (folder / "map.json").is_symlink()
    assert (folder / "map.json").read_bytes() == b"new"


@pytest.mark.parametrize("is_link", [False, True])
def test_a_pipe_that_a_user_names_is_written_into_and_stays(tmp_path: Path, is_link: bool) -> None:
    pipe = named = tmp_path / "pipe"
    os.mkfifo(pipe)
    if is_link:  # as /dev/stdout and a shell's >(...) are
        named = tmp_path / "named"
        named.symlink_to(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_output(named, b"new")
        assert os.read(reader, 10) == b"new"
    finally:
        os.close(reader)
    assert pipe.is_fifo()
    assert named.is_symlink() == is_link


def test_a_file_that_a_user_names_is_written_whole(tmp_path: Path) -> None:
    for content in (b"longer", b"new"):
        write_output(tmp_path / "map.json", content)
    assert (tmp_path / "map.json").read_bytes() == b"new"
    assert names(tmp_path) == ["map.json"]


@pytest.mark.parametrize("dangles", [True, False])
def test_a_link_at_the_unfinished_file_s_name_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, dangles: bool
) -> None:
    elsewhere = tmp_path / "elsewhere"
    if not dangles:
        elsewhere.write_bytes(b"not to be touched")
    folder = tmp_path / "maps"
    write_whole(folder / "map.json", b"old")
    opened = os.open
    planted: list[str] = []

    def plant(name: str, flags: int, mode: int = 0o777, *, dir_fd: int | None = None) -> int:
        if flags & os.O_CREAT:
            # The name is random: it can be guessed only here.
            (folder / name).symlink_to(elsewhere)
            planted.append(name)
        return opened(name, flags, mode, dir_fd=dir_fd)

    monkeypatch.setattr(os, "open", plant)
    with pytest.raises(FileExistsError):
        write_whole(folder / "map.json", b"new")
    assert len(planted) == 1
    assert elsewhere.exists() != dangles
    assert dangles or elsewhere.read_bytes() == b"not to be touched"
    assert (folder / "map.json").read_bytes() == b"old"


def test_names_of_unfinished_files_cannot_be_foreseen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: set[str] = set()
    monkeypatch.setattr(os, "fsync", lambda _: seen.update(names(tmp_path)))
    for _ in range(5):
        write_whole(tmp_path / "map.json", b"")
    assert len(seen - {"map.json"}) == 5


KILLED_WHILE_WRITING = """
import os, signal, sys
from pathlib import Path
from roomba.files.atomic import write_whole

os.replace = lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL)
write_whole(Path(sys.argv[1]), b"new")
"""


def test_what_a_killed_writer_leaves_behind_is_removed_later(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    write_whole(path, b"old")
    killed = subprocess.run([sys.executable, "-c", KILLED_WHILE_WRITING, str(path)], check=False)
    assert killed.returncode == -signal.SIGKILL
    assert path.read_bytes() == b"old"
    (left,) = (entry for entry in tmp_path.iterdir() if entry != path)
    # It may be of a writer that is still at it.
    write_whole(path, b"newer")
    assert left.exists()
    long_ago = time.time() - 4000.0
    os.utime(left, (long_ago, long_ago))
    write_whole(path, b"newest")
    assert path.read_bytes() == b"newest"
    assert names(tmp_path) == ["map.json"]


def test_of_several_writers_each_ends_whole_and_readers_see_whole_files(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    contents = [bytes([letter]) * 200_000 for letter in b"abcd"]
    write_whole(path, contents[0])
    are_done = threading.Event()
    seen: set[bytes] = set()

    def read() -> None:
        while not are_done.is_set():
            seen.add(path.read_bytes())

    def write(content: bytes) -> None:
        for _ in range(25):
            write_whole(path, content)

    with ThreadPoolExecutor() as pool:
        reader = pool.submit(read)
        writers = [pool.submit(write, content) for content in contents]
        try:
            for writer in writers:
                writer.result(60.0)
        finally:
            are_done.set()
        reader.result(60.0)
    assert seen <= set(contents)
    assert path.read_bytes() in contents
    assert names(tmp_path) == ["map.json"]


def test_a_folder_that_is_a_file_is_the_disks_refusal(tmp_path: Path) -> None:
    (tmp_path / "folder").write_text("", encoding="utf-8")
    with pytest.raises(OSError, match="folder"):
        write_whole(tmp_path / "folder" / "map.json", b"")


def test_an_output_keeps_its_permissions_and_makes_no_folder(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    path.touch()
    path.chmod(0o644)
    write_output(path, b"new")
    assert (path.read_bytes(), path.stat().st_mode & 0o777) == (b"new", 0o644)
    with pytest.raises(FileNotFoundError, match="mistyped"):
        write_output(tmp_path / "mistyped" / "map.json", b"new")
    assert list(tmp_path.iterdir()) == [path]
