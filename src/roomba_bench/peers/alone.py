"""``python3 -I alone.py MODULE``: be that peer, where nothing of the robot can be imported.

Where the library is installed, the robot's own numpy and other packages lie beside this package,
but peers must use theirs. So this package alone is made importable, without its folder.
"""

from __future__ import annotations

import runpy
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

PACKAGE = Path(__file__).parents[1]


def make_known() -> None:
    """Let modules of this package be imported by their names."""
    spec = spec_from_file_location(
        PACKAGE.name, PACKAGE / "__init__.py", submodule_search_locations=[str(PACKAGE)]
    )
    assert spec is not None
    assert spec.loader is not None
    package = module_from_spec(spec)
    sys.modules[PACKAGE.name] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    make_known()
    runpy.run_module(f"{PACKAGE.name}.peers", run_name="__main__")
