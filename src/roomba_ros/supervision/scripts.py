"""Runs nodes' scripts in forks of a process that has imported what they need."""

from __future__ import annotations

import ast
import importlib
import runpy
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import rospy

from roomba.raster.distance import distance_to_nearest


def import_for(scripts: Iterable[Path]) -> None:
    """Import what scripts need, once for all forks of this process."""
    for script in scripts:
        importlib.import_module(_module_of(script))
    # The first call of any compiled function makes numba import most of itself.
    distance_to_nearest(np.ones((2, 2), np.bool_))


def be_node(script: Path, arguments: Sequence[str]) -> None:
    """Run a script, as its own process would; arguments like ``__name:=x`` are taken as well."""
    sys.argv[:] = [str(script), *arguments]
    rospy.names.reload_mappings(sys.argv)
    runpy.run_path(str(script), run_name="__main__")


def _module_of(script: Path) -> str:
    """Return the module that a node's script takes its main function from."""
    (module,) = (
        line.module
        for line in ast.parse(script.read_text(encoding="utf-8")).body
        if isinstance(line, ast.ImportFrom) and line.module
    )
    return module
