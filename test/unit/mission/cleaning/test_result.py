"""What the result of a clean says of itself."""

from __future__ import annotations

from roomba.mission.cleaning.result import CleanOutcome, CleanResult


def test_a_result_tells_its_share() -> None:
    def result(wanted: float, covered: float) -> CleanResult:
        return CleanResult(CleanOutcome.COMPLETED, "", wanted, covered, 0.0, 0.0, 0.0, 0.0)

    assert result(8.0, 6.0).fraction == 0.75
    assert result(0.0, 0.0).fraction == 1.0
