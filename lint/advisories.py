"""Looks packages of PyPI up among known vulnerabilities, by pip-audit."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from typing import Final

from lint.materials import Material

_PATIENCE: Final = 300.0
"""s of wall time for the audit."""


def audit(materials: Sequence[Material]) -> int:
    """Look the packages of PyPI up, and print what is known; return 1 if one is vulnerable.

    A service that does not answer is reported, but does not count as a vulnerability.
    """
    pinned = "".join(
        f"{each.name}=={each.version}\n" for each in materials if each.source == "pypi"
    )
    with tempfile.NamedTemporaryFile("w", suffix=".txt", encoding="utf-8") as file:
        file.write(pinned)
        file.flush()
        options = ["--no-deps", "--disable-pip", "--progress-spinner=off", "--format=json"]
        done = subprocess.run(
            [sys.executable, "-m", "pip_audit", "--requirement", file.name, *options],
            check=False,
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
        )
    told, status = verdict(done.stdout, done.stderr)
    print(f"./roomba sbom: {told}", file=sys.stderr)
    return status


def verdict(answer: str, errors: str) -> tuple[str, int]:
    """Return what an audit found, in words, and 1 if it found something; ``answer`` is JSON."""
    try:
        asked = json.loads(answer)["dependencies"]
    except ValueError:
        reason = (errors.strip().splitlines() or ["it says nothing"])[-1]
        return f"nothing could be looked up, as the service does not answer: {reason}", 0
    known = [each for each in asked if "skip_reason" not in each]
    found = [
        f"{each['name']} {each['version']}: {fault['id']}, mended in "
        f"{', '.join(fault['fix_versions']) or 'no version yet'}"
        for each in known
        for fault in each["vulns"]
    ]
    if found:
        return "\n".join(("known vulnerabilities:", *found)), 1
    if not known:
        return (
            f"nothing could be looked up: {asked[0]['skip_reason'] if asked else 'no package'}",
            0,
        )
    return f"{len(known)} of {len(asked)} packages were looked up, none is vulnerable", 0
