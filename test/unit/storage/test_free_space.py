"""A disk with too little room is recognized by its free space."""

import errno
import shutil
from pathlib import Path

import pytest

from roomba.storage.free_space import require_free_space


def test_enough_room_is_no_problem_for_a_folder_that_is_not_there_yet(tmp_path: Path) -> None:
    require_free_space(tmp_path / "not" / "there", 1.0)
    assert not (tmp_path / "not").exists()


def test_too_little_room_is_told_with_both_sizes_and_the_folder(tmp_path: Path) -> None:
    least = 2.0 * shutil.disk_usage(tmp_path).total
    with pytest.raises(OSError, match="No space left on device") as found:
        require_free_space(tmp_path / "not there", least)
    assert found.value.errno == errno.ENOSPC
    assert f"{least / 1e6:g} MB are needed; make room" in str(found.value)
    assert found.value.filename == str(tmp_path)
