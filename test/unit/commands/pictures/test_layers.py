"""The picture of the layers is drawn from the sources, and says what it needs for that."""

import sys
from pathlib import Path

import pytest

from roomba.commands.pictures.__main__ import main


def test_without_the_reader_of_imports_the_command_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "grimp", None)
    assert main([str(tmp_path), "--only", "layers"]) == 1
    assert "requirements-dev.txt" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
