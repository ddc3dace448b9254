from __future__ import annotations

import sys

import pytest

from roomba.commands.program_name import spelled


@pytest.mark.parametrize(
    ("called", "said"),
    [
        ("/opt/venv/bin/roomba", "roomba sim"),
        ("roomba.exe", "roomba sim"),
        ("/home/me/src/roomba/commands/sim/__main__.py", "./roomba sim"),
    ],
)
def test_the_installed_program_is_spelled_without_a_folder(
    monkeypatch: pytest.MonkeyPatch, called: str, said: str
) -> None:
    monkeypatch.setattr(sys, "argv", [called])
    assert spelled("sim") == said
