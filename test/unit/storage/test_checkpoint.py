import os
from pathlib import Path

import numpy as np
import pytest

from roomba.storage.checkpoint import (
    Checkpoint,
    CheckpointFileError,
    load_checkpoint,
    load_dirt,
    remove_checkpoint,
    save_checkpoint,
    save_dirt,
)

VALUES = {
    "phase": "CLEANING",
    "ledger": [1.5, 0.25, 0.0],
    "cleaning": {"swept": "eJw="},
    "by": None,
}


def test_a_checkpoint_comes_back_in_its_own_run_only(tmp_path: Path) -> None:
    path = tmp_path / "robot" / "map.json"
    assert load_checkpoint(path, "run 1", pytest.fail) is None
    save_checkpoint(Checkpoint(VALUES), "run 1", path)
    assert load_checkpoint(path, "run 1", pytest.fail) == (VALUES, 0, None)
    assert load_checkpoint(path, "run 2", pytest.fail) is None
    resumed = Checkpoint(VALUES, 2, ("clean", "/client-1-5.7", 5, 700_000_000))
    save_checkpoint(resumed, "run 1", path)
    assert load_checkpoint(path, "run 1", pytest.fail) == resumed
    remove_checkpoint(path)
    remove_checkpoint(path)
    assert load_checkpoint(path, "run 1", pytest.fail) is None


def test_who_is_killed_while_writing_finds_the_one_from_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.json"
    save_checkpoint(Checkpoint(VALUES), "run", path)

    def killed(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", killed)
    with pytest.raises(KeyboardInterrupt):
        save_checkpoint(Checkpoint({"phase": "DOCKING"}), "run", path)
    assert load_checkpoint(path, "run", pytest.fail) == (VALUES, 0, None)


@pytest.mark.parametrize(
    "text",
    [
        *(
            "",
            "{",
            "[1]",
            '{"run": "run"}',
            '{"run": "r", "taken_up": 0, "goal": null, "mission": 3}',
        ),
        '{"run": "run", "taken_up": 0, "goal": null, "mission": {"ledger": [NaN]}}',
        '{"run": "run", "taken_up": 0, "goal": [1, 2], "mission": {}}',
        '{"run": "run", "taken_up": 1e999, "goal": null, "mission": {}}',
        '{"run": "run", "taken_up": 0, "goal": null, "mission": ' + 100_000 * "[",
    ],
)
def test_a_damaged_checkpoint_is_named_and_set_aside(tmp_path: Path, text: str) -> None:
    path = tmp_path / "map.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CheckpointFileError, match=r"map\.json: expected.*set aside as map"):
        load_checkpoint(path, "run", pytest.fail)
    assert (tmp_path / "map.json.damaged").read_text(encoding="utf-8") == text
    assert load_checkpoint(path, "run", pytest.fail) is None


def test_a_checkpoint_that_is_a_pipe_is_set_aside(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    os.mkfifo(path)
    with pytest.raises(CheckpointFileError, match="got a pipe"):
        load_checkpoint(path, "run", pytest.fail)
    assert not path.exists()


def test_a_damaged_checkpoint_gives_way_to_the_one_before(tmp_path: Path) -> None:
    path, told = tmp_path / "map.json", list[str]()
    save_checkpoint(Checkpoint({"phase": "CLEANING"}), "run", path)
    save_checkpoint(Checkpoint({"phase": "DOCKING"}), "run", path)
    path.write_bytes(path.read_bytes().replace(b"DOCKING", b"MOCKING"))
    assert load_checkpoint(path, "run", told.append) == ({"phase": "CLEANING"}, 0, None)
    assert len(told) == 1
    assert "the one from before is used" in told[0]


def test_a_forgotten_errand_does_not_come_back(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    for phase in ("CLEANING", "DOCKING"):
        save_checkpoint(Checkpoint({"phase": phase}), "run", path)
    remove_checkpoint(path)
    assert load_checkpoint(path, "run", pytest.fail) is None
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_plain_value_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "map.json"
    with pytest.raises(ValueError, match="JSON compliant"):
        save_checkpoint(Checkpoint({"x": float("nan")}), "run", path)
    assert not path.exists()


def test_dirt_comes_back_bit_for_bit(tmp_path: Path) -> None:
    path = tmp_path / "map.npz"
    learned = np.array([[np.nan, 1.5, 0.1], [0.0, 3e-9, np.nan]], np.float32)
    assert load_dirt(path, (2, 3), pytest.fail) is None
    save_dirt(learned, path)
    read = load_dirt(path, (2, 3), pytest.fail)
    assert read is not None
    assert read.tobytes() == learned.tobytes()
    with pytest.raises(CheckpointFileError, match=r"shape \(4, 4\), got \(2, 3\)"):
        load_dirt(path, (4, 4), pytest.fail)


@pytest.mark.parametrize("content", [b"", b"PK", b"no zip at all"])
def test_a_broken_dirt_map_is_named(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "map.npz"
    path.write_bytes(content)
    with pytest.raises(CheckpointFileError, match=r"expected a dirt map: .*map\.npz: .*set aside"):
        load_dirt(path, (2, 3), pytest.fail)
    assert load_dirt(path, (2, 3), pytest.fail) is None
