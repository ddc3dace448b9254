"""A calibration comes back as it was kept; a damaged one is set aside, and told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from roomba.perception.calibration.calibration import Calibration
from roomba.storage.calibration import CalibrationError, load_calibration, save_calibration

KEPT = Calibration(
    np.linspace(-0.02, 0.02, 7),
    np.diag(np.linspace(1e-6, 1e-4, 7)),
    np.array([0.0, 0.01, 0.05, 0.0, 0.0, 0.006, -0.01]),
    321,
    0.235,
)


def test_it_comes_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "of_robots" / "one.yaml"
    assert load_calibration(path, pytest.fail) is None
    save_calibration(KEPT, path)
    again = load_calibration(path, pytest.fail)
    assert again is not None
    assert np.array_equal(again.errors, KEPT.errors)
    assert np.array_equal(again.covariance, KEPT.covariance)
    assert np.array_equal(again.applied, KEPT.applied)
    assert (again.windows, again.base) == (321, 0.235)
    assert [each.name for each in path.parent.iterdir()] == ["one.yaml"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("windows: 321", "windows: -3"),
        ("windows: 321", ""),
        ("applied: [0.0, ", "applied: [9.0, "),
        ("applied: [0.0, ", "applied: ["),
        ("errors:", "errors: {"),
        ("base: 0.235", "base: many"),
    ],
)
def test_a_damaged_one_is_set_aside(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "one.yaml"
    save_calibration(KEPT, path)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(CalibrationError, match=r"one\.yaml\.damaged"):
        load_calibration(path, pytest.fail)
    assert not path.exists()
    assert (tmp_path / "one.yaml.damaged").is_file()
    assert load_calibration(path, pytest.fail) is None


def test_half_a_file_is_set_aside(tmp_path: Path) -> None:
    path = tmp_path / "one.yaml"
    save_calibration(KEPT, path)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(CalibrationError, match="measures itself anew"):
        load_calibration(path, pytest.fail)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(CalibrationError, match="set aside"):
        load_calibration(path, pytest.fail)
