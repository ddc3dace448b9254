"""What is refused before any process of the robot starts."""

from __future__ import annotations

import pytest

from roomba_ros.supervision.run import USAGE, main


def test_a_home_that_is_not_there_is_refused_before_anything_starts(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["home:=studoi"]) == USAGE
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("./roomba run: ")
    assert "expected the name of a home there or the path of a map_server yaml" in told.err
    assert "got 'studoi'" in told.err
    assert "studio" in told.err
