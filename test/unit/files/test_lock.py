"""A lock that one holds at a time: others wait for it, but not for ever."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import pytest
from fixtures.waiting import wait_until

from roomba.files.lock import locked


def test_it_is_held_by_one_at_a_time(tmp_path: Path) -> None:
    inside: list[int] = []
    most: list[int] = []

    def hold() -> None:
        with locked(tmp_path / "lock", 10.0):
            inside.append(1)
            most.append(len(inside))
            time.sleep(0.001)
            inside.pop()

    threads = [threading.Thread(target=hold) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1] * 8


def test_it_is_waited_for_no_longer_than_was_said(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    with (
        locked(path, 1.0),
        pytest.raises(TimeoutError, match=r"expected lock to be free within 0\.05 s"),
        locked(path, 0.05),
    ):
        pass
    with locked(path, 0.0):
        pass


def test_what_waits_has_it_once_it_is_free(tmp_path: Path) -> None:
    path, has = tmp_path / "lock", threading.Event()

    def wait() -> None:
        with locked(path, 10.0):
            has.set()

    waiting = threading.Thread(target=wait)
    with locked(path, 1.0):
        waiting.start()
        assert not has.wait(0.05)
    wait_until(has.is_set, 10.0, "the one that waited has it")
    waiting.join()


def test_it_is_the_owners_alone_and_no_link_is_followed(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    with locked(path, 1.0):
        assert path.stat().st_mode & 0o777 == 0o600
    (tmp_path / "link").symlink_to(path)
    with pytest.raises(OSError, match="symbolic links"), locked(tmp_path / "link", 1.0):
        pass
