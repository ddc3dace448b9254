"""A run, made up."""

from __future__ import annotations

import pytest
from unit.history.made import made_figures, made_recording

from roomba.history.run import RunFigures, RunRecording


@pytest.fixture
def figures() -> RunFigures:
    return made_figures()


@pytest.fixture
def recording() -> RunRecording:
    return made_recording()
