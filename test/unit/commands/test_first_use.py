"""What a first clean needs is compiled by two processes, whose progress is shown."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from roomba.commands import first_use
from roomba.commands.first_use import Tell, compile_for_a_clean, require_compiled

TELLS = "import sys; print('1: a.first', flush=True); print('2: a.' + sys.argv[-1], flush=True)\n"
FAILS = "print('1: b.only', flush=True); raise SystemExit(1)\n"
STAYS = "import os, time; print(f'1: {os.getpid()}', flush=True); time.sleep(60.0)\n"


@pytest.fixture
def halves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of the modules clean.py and plan.py, which stand for the two halves."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(tmp_path), os.environ["PYTHONPATH"])))
    monkeypatch.setenv("PYTHONUNBUFFERED", "1")
    monkeypatch.setattr(first_use, "_CLEAN", "clean")
    monkeypatch.setattr(first_use, "_PLAN", "plan")
    return tmp_path


def test_both_halves_tell_what_they_compile(halves: Path) -> None:
    (halves / "clean.py").write_text(TELLS)
    (halves / "plan.py").write_text(TELLS)
    told: list[tuple[int, str]] = []
    assert compile_for_a_clean("ticks", lambda count, name: told.append((count, name)))
    assert [count for count, _ in told] == [1, 2, 3, 4]
    # The other half is given no argument: its last word is the name of the module's file.
    names = sorted(name for _, name in told)
    assert names[:3] == ["a." + str(halves / "plan.py"), "a.first", "a.first"]
    assert names[3] == "a.ticks"


@pytest.mark.parametrize("broken", ["clean", "plan"])
def test_a_half_that_fails_is_told_and_the_other_one_ends(halves: Path, broken: str) -> None:
    (halves / "clean.py").write_text(TELLS)
    (halves / "plan.py").write_text(TELLS)
    (halves / f"{broken}.py").write_text(FAILS)
    told: list[str] = []
    assert not compile_for_a_clean("bursts", lambda _, name: told.append(name))
    assert {"a.first", "b.only"} <= set(told)


def test_ctrl_c_ends_both_processes(halves: Path) -> None:
    (halves / "clean.py").write_text(STAYS)
    (halves / "plan.py").write_text(STAYS)
    processes: list[int] = []

    def interrupt(count: int, name: str) -> None:
        processes.append(int(name))
        if count == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        compile_for_a_clean("ticks", interrupt)
    for process in processes:
        with pytest.raises(ProcessLookupError):
            os.kill(process, signal.SIGCONT)


@pytest.mark.parametrize("is_quiet", [False, True])
def test_what_is_not_kept_is_compiled_and_told_in_a_pipe(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], is_quiet: bool
) -> None:
    compiled: list[str] = []

    def compile_it(half: str, tell: Tell) -> bool:
        compiled.append(half)
        tell(1, "a.first")
        return True

    monkeypatch.setattr(first_use, "is_kept", lambda _: False)
    monkeypatch.setattr(first_use, "compile_for_a_clean", compile_it)
    require_compiled(is_quiet=is_quiet)
    assert compiled == ["bursts"]
    told = capsys.readouterr()
    assert told.out == ""
    first = [line.split(";")[0].split(" in ")[0] for line in told.err.splitlines()]
    assert first == ([] if is_quiet else ["Compiling what a clean needs, once", "Compiled"])


def test_what_is_kept_is_not_compiled_again(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(first_use, "is_kept", lambda _: True)
    monkeypatch.setattr(first_use, "compile_for_a_clean", lambda *_: pytest.fail("compiled"))
    require_compiled(is_quiet=False)
    assert capsys.readouterr().err == ""
