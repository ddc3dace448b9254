"""A user's own stages of coverage planning, by import path: ``{swaths: my_module:my_swaths}``."""

from __future__ import annotations

import contextlib
import functools
import importlib
import importlib.util
import sys
import traceback
from collections.abc import Callable, Iterable
from dataclasses import fields
from modulefinder import ModuleFinder
from pathlib import Path
from typing import Any, Final

import numpy as np

from roomba.commands.options import UsageError
from roomba.errors import RoombaError
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages

NAMES: Final = tuple(field.name for field in fields(CoverageStages))
_OF_ONE_LINE: Final = ("connection", "polish", "rounding")
"""Stages that return one line; the others return a list of lines."""


class StageError(RoombaError):
    """A stage failed, or returned something else than lines."""


def stages_of(paths: Iterable[tuple[str, str]], code: Path | None = None) -> CoverageStages:
    """Return the stages of a trial: of its import paths, and ours for the others.

    Modules may lie in the folder ``code``. Raises UsageError for an unknown stage, and for a module
    or function that cannot be imported.
    """
    chosen = {name: _checked(name, path, _function_of(name, path, code)) for name, path in paths}
    return CoverageStages(**chosen) if chosen else OUR_STAGES


def files_of_stage(name: str, path: str, code: Path | None = None) -> dict[str, Path]:
    """Return the file that a stage is in, and those beside it that it imports, by their names.

    Empty if the stage's module has no file. Raises UsageError.
    """
    module = _module_of(name, path, code)
    if module.__file__ is None:
        return {}
    file = Path(module.__file__)
    root = code if code is not None and code in file.parents else file.parent
    finder = ModuleFinder([str(root)])
    with contextlib.suppress(ImportError):  # a relative import: modules found before it count
        finder.run_script(str(file))
    modules: Iterable[Any] = finder.modules.values()
    found = (Path(each.__file__) for each in modules if each.__file__)
    return {str(each.relative_to(root)): each for each in (file, *found) if root in each.parents}


def _module_of(name: str, path: str, code: Path | None) -> Any:
    if name not in NAMES:
        raise UsageError(f"stages: expected {', '.join(NAMES)}, got {name!r}")
    module, sign, function = path.partition(":")
    if not (module and sign and function):
        raise UsageError(f"stages: {name}: expected MODULE:FUNCTION, got {path!r}")
    if code is not None and sys.path[:1] != [str(code)]:
        # First, before the current folder, where a file may have the same name.
        sys.path.insert(0, str(code))
    try:
        return importlib.import_module(module)
    except (Exception, SystemExit) as error:  # a user's module may raise anything, or exit
        where = "" if code is None else f", also not in {code}"
        raise UsageError(
            f"stages: {name}: expected a module that can be imported, got {module!r}{where}: "
            f"{error!r}"
        ) from error


def _function_of(name: str, path: str, code: Path | None) -> Callable[..., Any]:
    function = functools.reduce(
        lambda found, word: getattr(found, word, None),
        path.partition(":")[2].split("."),
        _module_of(name, path, code),
    )
    if not callable(function):
        raise UsageError(f"stages: {name}: expected a function, got none at {path!r}")
    found: Callable[..., Any] = function
    return found


def _checked(name: str, path: str, stage: Callable[..., Any]) -> Callable[..., Any]:
    """Return the stage with a check of its result, which must suit the next stage."""

    @functools.wraps(stage)
    def checked(*arguments: Any) -> Any:
        try:
            given = stage(*arguments)
        except (Exception, SystemExit) as error:  # a user's code may raise anything, or exit
            raise StageError(f"{path}: {error!r}{_place_of(error)}") from error
        lines = [given] if name in _OF_ONE_LINE else given
        if not isinstance(lines, list) or not all(map(_is_line, lines)):
            what = "an array" if name in _OF_ONE_LINE else "a list of arrays"
            raise StageError(
                f"{path}: expected {what}, float64 [n >= 1, 2], of finite places, in cells, got "
                f"{_description(given)}"
            )
        if name == "order" and arguments[0] and not lines:
            raise StageError(
                f"{path}: expected the {len(arguments[0])} pieces in some order, got none of them"
            )
        return given

    return checked


def _place_of(error: BaseException) -> str:
    """Return the file and line that an error was raised in, in words."""
    raised = traceback.extract_tb(error.__traceback__)[-1]
    return f" ({raised.filename}, line {raised.lineno})"


def _is_line(line: object) -> bool:
    return (
        isinstance(line, np.ndarray)
        and line.dtype == np.float64
        and line.ndim == 2
        and line.shape[0] >= 1
        and line.shape[1] == 2
        and bool(np.isfinite(line).all())
    )


def _description(given: object) -> str:
    if isinstance(given, np.ndarray):
        return f"{given.dtype} of shape {given.shape}"
    if isinstance(given, list):
        bad = next((line for line in given if not _is_line(line)), None)
        return f"a list with {_description(bad)}"
    return type(given).__name__
