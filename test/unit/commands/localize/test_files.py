"""The files of a localized drive."""

import os
from pathlib import Path

import pytest

from roomba.commands.localize.files import RowBag


def test_a_bag_takes_no_pipe_s_or_device_s_place(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="expected a file, got a pipe or a device"):
        RowBag(pipe, "odom")
    assert pipe.is_fifo()
