"""A thread of its own keeps what the recorder sees: all of it, or it reports what is lost."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from unit.history.seen import HOME, REPORT, SOURCE, view

from roomba.client.view import GridLayer, LayerName
from roomba.history.database import History
from roomba.history.keeping import KeepingThread
from roomba.history.recorder import HistoryKeeper

LAYERS = {LayerName.MAP: GridLayer(1, 0.05, 0.0, 0.0, np.ones((4, 5), np.uint8))}


def test_a_run_that_ended_is_kept_before_the_end(tmp_path: Path) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    keeping = KeepingThread(keeper)
    keeping.start()
    keeping.look(view(0.0, "cleaning"), HOME, LAYERS)
    keeping.look(view(9.0, "docked", REPORT), HOME, LAYERS)
    keeping.stop()
    assert [run.is_recorded for run in keeper.history.runs()] == [True]


def test_what_a_slow_disk_has_no_time_for_is_told_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.history.keeping._AHEAD", 3)
    monkeypatch.setattr("roomba.history.keeping._ENDS_WITHIN", 0.01)
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    goes_on = threading.Event()
    monkeypatch.setattr(keeper, "look", lambda *_: goes_on.wait(10.0))
    keeping = KeepingThread(keeper)
    keeping.start()
    try:
        for tenth in range(9):
            keeping.look(view(tenth / 10.0, "cleaning"), HOME, LAYERS)
        keeping.stop()
    finally:
        goes_on.set()
    assert [text.split(": ")[1] for text in told] == [
        "some of a run is not kept",
        "its end is not kept",
    ]
