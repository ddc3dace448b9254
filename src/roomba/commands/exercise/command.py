"""``./roomba exercise``: lists the exercises, begins one, or checks what was written for one."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Final

from roomba.commands.exercise.course import COURSE, Exercise
from roomba.commands.exercise.verdict import NOT_YET, PASSED
from roomba.commands.options import Parser, UsageError, whole
from roomba.commands.program_name import spelled

PROGRAM: Final = spelled("exercise")
_USAGE: Final = 2


def main(arguments: list[str] | None = None) -> int:
    """Return 0, also for an answer that passes; 1 if it does not pass yet; 2 for wrong usage."""
    parser = Parser(PROGRAM, "Tasks that teach the robot's parts, with checks.", "")
    parser.add_argument("number", nargs="?", type=whole(1, len(COURSE)), help="which one")
    parser.add_argument("--check", action="store_true", help="check what you wrote")
    parser.add_argument("--file", type=Path, help="your file (default: its name, beside you)")
    try:
        given = parser.parse_args(arguments)
        if given.number is None:
            if given.check or given.file is not None:
                raise UsageError("expected the number of an exercise")
            print(_listed())
            return 0
        exercise = COURSE[given.number - 1]
        file = given.file or Path(f"{exercise.name}.py")
        return _checked(exercise, file) if given.check else _begun(given.number, exercise, file)
    except UsageError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return _USAGE


def _listed() -> str:
    lines = [f"{number}. {each.about}" for number, each in enumerate(COURSE, 1)]
    return "\n".join([*lines, "", f"{PROGRAM} 1 begins the first one."])


def _begun(number: int, exercise: Exercise, file: Path) -> int:
    """Print the text, and give the file to begin with, unless there is one."""
    print(exercise.text.read_text("utf-8").strip())
    if file.exists():
        print(f"\nYour file is {file}.")
    else:
        try:
            shutil.copyfile(exercise.start, file)
        except OSError as error:
            raise UsageError(
                f"{file}: cannot be written: {error.strerror}; name another"
            ) from error
        print(f"\n{file} is what you begin with.")
    print(f"To check it: {PROGRAM} {number} --check")
    return 0


def _checked(exercise: Exercise, file: Path) -> int:
    """Run the check in a process of its own: an answer may never end, or end the process."""
    if not file.is_file():
        raise UsageError(f"expected your answer in {file}, there is no such file")
    command = [sys.executable, "-m", exercise.check, str(file.resolve())]
    with subprocess.Popen(command, start_new_session=True) as check:
        try:
            status = check.wait(exercise.deadline)
        except subprocess.TimeoutExpired:
            print(
                f"not yet: it has not ended after {exercise.deadline:g} s; does a loop go on for "
                "ever?"
            )
            return NOT_YET
        finally:
            # What the answer began, too; also after Ctrl-C, which goes to this process alone.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(check.pid, signal.SIGKILL)
    if status not in (PASSED, NOT_YET):
        print(f"not yet: your program ended the check, with status {status}")
    return 0 if status == PASSED else NOT_YET
