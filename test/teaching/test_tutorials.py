"""Tutorials without ROS come out as they are written, typed by a reader who knows nothing else."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fixtures.tutorial import ROOT, Reader

WITHOUT_ROS = (
    "a_coverage_stage", "a_create_2", "a_home_of_your_own", "a_policy", "how_a_clean_is_proven",
)  # fmt: skip


@pytest.mark.parametrize("name", WITHOUT_ROS)
def test_what_is_done_without_ros(name: str, tmp_path: Path) -> None:
    with Reader(tmp_path, os.environ) as reader:
        reader.read(ROOT / "docs" / "tutorials" / f"{name}.md")
