"""The safety layer is what it is told to be, and reasons are of lines that there are."""

from __future__ import annotations

import pytest
from safety.layer import ROOT, layer
from safety.mutants import Mutant, reasons

MODULES, TESTS = layer()


@pytest.mark.parametrize("path", [*MODULES, *TESTS])
def test_what_is_named_is_there(path: str) -> None:
    assert (ROOT / path).exists()


@pytest.mark.parametrize("mutant", reasons(), ids=lambda mutant: mutant.new)
def test_a_reason_is_of_a_line_that_there_is(mutant: Mutant) -> None:
    assert f"src/{mutant.module}" in MODULES
    text = (ROOT / "src" / mutant.module).read_text("utf-8")
    assert mutant.old in " ".join(text.split())
    assert mutant.new not in text
    assert len(reasons()[mutant]) > 20
