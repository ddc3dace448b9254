"""The bill of materials, made by the command from what is installed."""

import json
import subprocess
from importlib.metadata import version
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def test_it_names_what_the_robot_is_made_of(tmp_path: Path) -> None:
    file = tmp_path / "bill.json"
    done = subprocess.run(
        ["./roomba", "sbom", "--out", file, "--audit"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=600.0,
        check=False,
    )
    # A vulnerable package is told and makes the status 1; that is no fault of the bill.
    assert done.returncode in (0, 1), done.stderr
    assert any(
        told in done.stderr
        for told in ("could be looked up", "were looked up", "known vulnerabilities:")
    )
    bill = json.loads(file.read_text("utf-8"))
    assert (bill["bomFormat"], bill["metadata"]["component"]["name"]) == (
        "CycloneDX",
        "roomba_robot",
    )
    addresses = {component["purl"] for component in bill["components"]}
    assert f"pkg:pypi/numba@{version('numba')}" in addresses
    assert any(address.startswith("pkg:deb/debian/python3-rospy@") for address in addresses)
    # What the tests and this command need is no part of the robot.
    assert not any("pytest" in address or "cyclonedx" in address for address in addresses)
    references = {component["bom-ref"] for component in bill["components"]}
    needed = {one for row in bill["dependencies"] for one in row.get("dependsOn", [])}
    assert needed <= references
