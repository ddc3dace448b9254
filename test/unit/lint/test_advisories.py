"""How the findings of an audit are reported."""

import json
from collections.abc import Mapping

from lint.advisories import verdict

FINE = {"name": "numba", "version": "0.6", "vulns": []}
SKIPPED = {"name": "scipy", "version": "1", "skip_reason": "not found on PyPI"}
BAD = {
    "name": "pillow",
    "version": "9",
    "vulns": [
        {"id": "PYSEC-1", "fix_versions": ["10.1", "9.9"]},
        {"id": "PYSEC-2", "fix_versions": []},
    ],
}


def answer(*asked: Mapping[str, object]) -> str:
    return json.dumps({"dependencies": asked})


def test_vulnerable_packages_are_named_and_make_the_status() -> None:
    told, status = verdict(answer(FINE, BAD, SKIPPED), "")
    assert status == 1
    assert told.splitlines() == [
        "known vulnerabilities:",
        "pillow 9: PYSEC-1, mended in 10.1, 9.9",
        "pillow 9: PYSEC-2, mended in no version yet",
    ]


def test_what_was_not_looked_up_is_not_called_safe() -> None:
    assert verdict(answer(FINE, SKIPPED), "") == (
        "1 of 2 packages were looked up, none is vulnerable",
        0,
    )
    assert verdict(answer(SKIPPED), "") == ("nothing could be looked up: not found on PyPI", 0)


def test_a_service_that_does_not_answer_is_told() -> None:
    told, status = verdict("", "WARNING: slow\nConnectionError: no route\n")
    assert status == 0
    assert told.endswith("as the service does not answer: ConnectionError: no route")
