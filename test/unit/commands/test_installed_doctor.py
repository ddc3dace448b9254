from __future__ import annotations

import json

import pytest

from roomba.commands import installed_doctor


@pytest.mark.parametrize(
    ("lacks", "status", "mend"),
    [
        ("numba", 1, "install roomba_robot anew with pip"),
        ("gymnasium", 0, "pip install 'roomba_robot[gym]', if you want it"),
    ],
)
def test_what_cannot_be_imported_is_told_with_what_mends_it(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    lacks: str,
    status: int,
    mend: str,
) -> None:
    def reasons(_: object, modules: tuple[str, ...], __: object) -> dict[str, str]:
        return {module: "no such module" if module == lacks else "" for module in modules}

    monkeypatch.setattr(installed_doctor, "why_not_all_importable", reasons)
    assert installed_doctor.main(["--json"]) == status
    told = json.loads(capsys.readouterr().out)
    wrong = [row for row in told if row["state"] != "fine"]
    assert [(row["subject"], row["mend"]) for row in wrong] == [(lacks, mend)]
