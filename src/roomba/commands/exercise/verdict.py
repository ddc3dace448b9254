"""What a check says of a learner's file: passed, or what is not right yet."""

from __future__ import annotations

import importlib.util
import sys
import traceback
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import Any, Final

PASSED: Final = 10
"""Exit status of a passed check; not 0, since an answer that ends the process would pass by
that."""
NOT_YET: Final = 1


class NotYetError(Exception):
    """What is not right yet: what was expected, and what came, in a sentence."""


def expect(is_right: bool, sentence: str) -> None:
    """Raise NotYetError with the sentence unless something is right."""
    if not is_right:
        raise NotYetError(sentence)


def loaded(file: Path) -> ModuleType:
    """Return the learner's module, of a file of any name; raises what the file raises."""
    loader = SourceFileLoader("answer", str(file))
    spec = importlib.util.spec_from_loader("answer", loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["answer"] = module
    loader.exec_module(module)
    return module


def function_of(file: Path, name: str) -> Callable[..., Any]:
    """Return the learner's function; raises NotYetError if the file has none of that name."""
    found = getattr(loaded(file), name, None)
    if not callable(found):
        raise NotYetError(f"expected a function {name}() in {file.name}, there is none")
    function: Callable[..., Any] = found
    return function


def judged(check: Callable[[Path], str]) -> int:
    """Check the file of the command line, print what comes of it, and return the exit status.

    An error of the learner's own code is told with the line in it.
    """
    file = Path(sys.argv[1])
    try:
        print(f"passed: {check(file)}")
    except NotYetError as error:
        print(f"not yet: {error}")
        return NOT_YET
    except SystemExit as error:
        print(f"not yet: your program ended the check, with status {error.code or 0}")
        return NOT_YET
    except Exception as error:
        print(f"not yet: {type(error).__name__}: {error}{_line_in(file, error)}")
        return NOT_YET
    return PASSED


def _line_in(file: Path, error: Exception) -> str:
    """Return where an error came up, in words: the last line of the learner's file, if any."""
    if isinstance(error, SyntaxError):
        # A syntax error names its line itself.
        return ""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame for frame in frames if Path(frame.filename) == file]
    if lines:
        return f" ({file.name}, line {lines[-1].lineno}: {lines[-1].line})"
    return f" (where {file.name} is called, or what it returned is read; does it fit the text?)"
