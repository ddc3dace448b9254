"""Any file: its reader takes it or raises its own error, soon, and in bounded memory.

``ROOMBA_EXAMPLES=5000`` tries so many files of each kind, others each time.
"""

from __future__ import annotations

import os
import resource
import time
from pathlib import Path
from typing import Final

import pytest
from fixtures.file_kinds import KINDS, Kind
from fixtures.spoiled import spoiled
from hypothesis import HealthCheck, given, settings

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 40,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
SOON: Final = 5.0
"""s of processor time; the largest file that is read takes about one."""
MEMORY: Final = 1_500_000_000
"""Bytes by which the process may grow over all files."""


@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
def test_a_spoiled_file_is_read_or_refused_by_its_own_error(kind: Kind, tmp_path: Path) -> None:
    path, whole = tmp_path / kind.name, kind.whole()
    path.write_bytes(whole)
    kind.read(path)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    @FUZZ
    @given(spoiled(whole))
    def try_one(content: bytes) -> None:
        for left in tmp_path.iterdir():
            left.unlink()
        path.write_bytes(content)
        began, refusal = time.process_time(), "none"
        try:
            kind.read(path)
        except kind.errors as error:
            refusal = str(error)
        assert refusal
        assert time.process_time() - began < SOON

    try_one()
    grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    assert grown < MEMORY
