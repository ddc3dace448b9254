"""The time of whole commands: calls take turns, the best counts, and failures are reported."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from roomba_bench.topics.runs import Spent, fastest, rows_of, spent_by


def python(program: str) -> list[str]:
    return [sys.executable, "-c", program]


def test_the_time_of_a_command_and_of_what_it_starts_counts() -> None:
    busy = "import time\nwhile time.process_time() < 0.2: pass"
    once = spent_by(python(busy), {})
    started = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {busy!r}])"
    nested = spent_by(python(started), {})
    assert 0.2 <= once.computing <= once.wall + 0.05
    assert nested.computing >= 0.2


def test_a_command_that_fails_is_told_with_what_it_said() -> None:
    with pytest.raises(RuntimeError, match="got 3: no home"):
        spent_by(python("import sys; sys.stderr.write('no home'); sys.exit(3)"), {})


def test_commands_run_in_turns_and_the_first_call_does_not_count(tmp_path: Path) -> None:
    calls = [
        python(f"import os; open(os.environ['LOG'], 'a').write({name!r})") for name in ("a", "b")
    ]
    best = fastest(calls, 2, {"LOG": str(tmp_path / "log")})
    assert len(best) == 2
    assert (tmp_path / "log").read_text() == "ababab"


def test_rows_have_the_other_checkout_as_a_peer() -> None:
    ours, other = Spent(1.2, 1.0), Spent(2.4, 3.0)
    alone = rows_of("sim", "flat", [ours], None)
    assert [(row.value, row.aim, row.peers) for row in alone] == [(1.2, 1.5, ()), (1.0, None, ())]
    rows = rows_of("sim", "flat", [ours, other], "/somewhere/older")
    assert [row.ratio(row.peers[0]) for row in rows] == [2.0, 3.0]
    assert rows[0].peers[0].name == "before (older)"
