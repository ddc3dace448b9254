"""A plugin of pytest: the names of the tests that failed, in the file of ``--failed-to``."""

from __future__ import annotations

from pathlib import Path

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take the name of the file."""
    parser.addoption("--failed-to", type=Path, help="a file for the names of tests that failed")


def pytest_configure(config: pytest.Config) -> None:
    """Note failures in the main process: it hears of all tests, workers only of their own."""
    path = config.getoption("--failed-to")
    if path is not None and not hasattr(config, "workerinput"):
        path.write_text("", encoding="utf-8")
        config.pluginmanager.register(_Listener(path))


class _Listener:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._names: set[str] = set()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a test that failed, only once: it may fail again in its teardown."""
        if report.failed and report.nodeid not in self._names:
            self._names.add(report.nodeid)
            with self._path.open("a", encoding="utf-8") as file:
                file.write(f"{report.nodeid}\n")
