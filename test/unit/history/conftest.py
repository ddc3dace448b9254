"""A run, made up."""

from __future__ import annotations

import pytest
from unit.history.made import made_figures, made_recording

from roomba.history.run import Recording, RunFigures


@pytest.fixture
def figures() -> RunFigures:
    return made_figures()


@pytest.fixture
def recording() -> Recording:
    return made_recording()
