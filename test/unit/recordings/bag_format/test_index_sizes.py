"""Bags whose indexes tell 20 bytes for each message and have 12, as programs of 2010 wrote them."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.drives.made_logs import drive, write_bag
from fixtures.drives.old_bags import as_of_2010

from roomba.recordings.bag_file import BagFile, Raw
from roomba.recordings.bag_format.index_sizes import has_wrong_sizes, mend_sizes

SECONDS = 4.0


def old(path: Path) -> tuple[Path, bytes]:
    """Write a bag as such a program did; return it, and what it would be without the fault."""
    whole = write_bag(path, drive(SECONDS)).read_bytes()
    path.write_bytes(as_of_2010(whole))
    return path, whole


def messages(path: Path) -> list[Raw]:
    bag = BagFile(path)
    try:
        return list(bag.merged(["/odom", "/scan"]))
    finally:
        bag.close()


def test_wrong_sizes_are_put_right(tmp_path: Path) -> None:
    path, whole = old(tmp_path / "old.bag")
    assert has_wrong_sizes(path)
    assert mend_sizes(path) > 0
    assert path.read_bytes() == whole
    assert not has_wrong_sizes(path)
    assert mend_sizes(path) == 0


@pytest.mark.parametrize("share", [1.0, 0.7])
def test_such_a_bag_is_read_whole_or_cut_short_and_left_as_it_is(
    tmp_path: Path, share: float
) -> None:
    path, whole = old(tmp_path / "old.bag")
    data = path.read_bytes()[: round(share * len(whole))]
    path.write_bytes(data)
    good = tmp_path / "good.bag"
    good.write_bytes(whole[: len(data)])
    assert messages(path) == messages(good)
    assert path.read_bytes() == data


def test_what_is_no_bag_has_no_sizes(tmp_path: Path) -> None:
    path = tmp_path / "none.bag"
    for data in (b"", b"something else", b"#ROSBAG V2.0\n", b"#ROSBAG V2.0\n\5\0\0\0abc"):
        path.write_bytes(data)
        assert not has_wrong_sizes(path)
