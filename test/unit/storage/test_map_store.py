"""Maps by name: a stored map is always whole, also after a kill, and names are sensible."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.storage import map_store
from roomba.storage.map_store import LONGEST_NAME, MapStore, MapStoreError, StoredMap


def floor(station_x: float = 1.0) -> StoredMap:
    frame = GridFrame(0.05, -0.1, -0.1, 44, 64)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    return StoredMap(OccupancyMap(frame, values), Pose(station_x, 1.0, 0.5))


@pytest.fixture
def store(tmp_path: Path) -> MapStore:
    return MapStore(tmp_path / "not" / "yet" / "there")


def entries(store: MapStore) -> list[str]:
    return sorted(entry.name for entry in store.folder.iterdir())


def test_a_store_begins_with_nothing(store: MapStore) -> None:
    assert store.names() == ()
    with pytest.raises(MapStoreError, match="expected one of no maps, got 'attic'"):
        store.load("attic")


def test_maps_are_kept_by_name(store: MapStore) -> None:
    for number, name in enumerate(("upstairs", "Küche 2", "cellar")):
        store.save(name, floor(1.0 + 0.1 * number))
    assert store.names() == ("Küche 2", "cellar", "upstairs")
    assert MapStore(store.folder).load("Küche 2").is_same(floor(1.1))
    assert store.load("cellar").is_same(floor(1.2))


def test_the_newest_replaces_and_the_one_before_is_left(store: MapStore) -> None:
    for x in (1.0, 1.2, 1.5):
        store.save("home", floor(x))
    assert store.load("home").is_same(floor(1.5))
    assert entries(store) == [".home.before", "home"]
    assert store.names() == ("home",)


@pytest.mark.parametrize("file", ["map.pgm", "map.yaml", "home.yaml", "zones.yaml"])
def test_a_damaged_map_is_set_aside_and_the_one_before_is_used(store: MapStore, file: str) -> None:
    told: list[str] = []
    store.save("home", floor(1.2))
    store.save("home", floor(1.5))
    path = store.folder / "home" / file
    path.write_bytes(path.read_bytes()[:-1] + b"x")
    with pytest.raises(MapStoreError, match=f"{file}: .*checksum"):
        store.load("home")
    telling = MapStore(store.folder, told.append)
    assert telling.load("home").is_same(floor(1.2))
    assert len(told) == 1
    assert f"{file}: expected what its checksum says" in told[0]
    assert "set aside as .home.damaged, and the one before is used" in told[0]
    assert entries(store) == [".home.damaged", "home"]
    assert store.load("home").is_same(floor(1.2))
    path.write_bytes(path.read_bytes()[:-1] + b"x")
    with pytest.raises(MapStoreError, match="checksum"):
        telling.load("home")
    store.remove("home")
    assert entries(store) == []


def test_a_damaged_map_does_not_become_the_one_before(store: MapStore) -> None:
    store.save("home", floor(1.0))
    store.save("home", floor(1.2))
    (store.folder / "home" / "map.pgm").write_bytes(b"P5\n")
    store.save("home", floor(1.5))
    (store.folder / "home" / "map.pgm").write_bytes(b"P5\n")
    assert MapStore(store.folder, lambda _: None).load("home").is_same(floor(1.0))


def test_a_map_is_its_owner_s_alone(store: MapStore) -> None:
    store.save("home", floor())
    inside = sorted((store.folder / "home").iterdir())
    folders = {folder.stat().st_mode & 0o777 for folder in (store.folder, inside[0].parent)}
    assert (folders, {file.stat().st_mode & 0o777 for file in inside}) == ({0o700}, {0o600})


def test_the_one_before_goes_with_its_map(store: MapStore) -> None:
    store.save("home", floor(1.0))
    store.save("home", floor(1.2))
    store.rename("home", "house")
    assert entries(store) == [".house.before", "house"]
    store.remove("house")
    assert entries(store) == []


def test_a_map_is_removed(store: MapStore) -> None:
    store.save("one", floor())
    store.save("two", floor())
    store.remove("one")
    assert entries(store) == ["two"]
    with pytest.raises(MapStoreError, match="expected one of 'two', got 'one'"):
        store.remove("one")


def test_a_map_is_renamed_and_takes_no_others_place(store: MapStore) -> None:
    store.save("one", floor(1.1))
    store.save("two", floor(1.2))
    store.rename("one", "three")
    assert store.names() == ("three", "two")
    assert store.load("three").is_same(floor(1.1))
    store.rename("two", "two")
    with pytest.raises(MapStoreError, match="a name that no map has, got 'two'"):
        store.rename("three", "two")
    assert store.load("two").is_same(floor(1.2))
    with pytest.raises(MapStoreError, match="did you mean 'three'"):
        store.rename("thre", "four")


@pytest.mark.parametrize(
    "name",
    [
        "",
        " ",
        " a",
        "a ",
        ".",
        "..",
        ".hidden",
        "a/b",
        "a\\b",
        "/",
        "v1.0",
        "a\nb",
        "a\0b",
        "\ud800",
    ],
)
def test_names_that_no_folder_should_have_are_refused(store: MapStore, name: str) -> None:
    store.save("good", floor())
    for act in (
        lambda: store.save(name, floor()),
        lambda: store.load(name),
        lambda: store.remove(name),
        lambda: store.rename("good", name),
        lambda: store.rename(name, "other"),
    ):
        with pytest.raises(MapStoreError, match="expected a map's name of 1 to 50 characters"):
            act()
    assert entries(store) == ["good"]


def test_the_longest_name_fits(store: MapStore) -> None:
    name = "\N{DOG FACE}" * LONGEST_NAME
    store.save(name, floor())
    store.save(name, floor())
    assert store.names() == (name,)
    with pytest.raises(MapStoreError, match="1 to 50 characters"):
        store.save(name + "x", floor())


def test_a_broken_map_hides_no_other_and_can_be_replaced_or_removed(store: MapStore) -> None:
    for name in ("a", "b", "c"):
        store.save(name, floor())
    (store.folder / "b" / "map.pgm").unlink()
    (store.folder / "a" / "map.yaml").write_text("[")
    assert store.names() == ("a", "b", "c")
    with pytest.raises(MapStoreError, match=r"b/map\.yaml.*expected a picture"):
        store.load("b")
    with pytest.raises(MapStoreError, match=r"a/map\.yaml"):
        store.load("a")
    assert store.load("c").is_same(floor())
    store.save("b", floor(1.3))
    assert store.load("b").is_same(floor(1.3))
    store.remove("a")
    assert store.names() == ("b", "c")


@pytest.mark.parametrize("planted", ["home", ".home.new", ".home.old", ".home.gone"])
def test_links_in_the_folder_are_not_followed(
    store: MapStore, tmp_path: Path, planted: str
) -> None:
    elsewhere = MapStore(tmp_path / "elsewhere")
    elsewhere.save("home", floor(1.0))
    store.folder.mkdir(parents=True)
    (store.folder / planted).symlink_to(elsewhere.folder / "home")
    assert store.names() == ()
    with pytest.raises(MapStoreError, match="expected one of no maps"):
        store.load("home")
    store.save("home", floor(1.5))
    assert entries(store) == ["home"]
    assert not (store.folder / "home").is_symlink()
    assert store.load("home").is_same(floor(1.5))
    assert elsewhere.load("home").is_same(floor(1.0))


class Killed(BaseException):
    """What happens to a process, and cannot be handled by it."""


STEPS = ("mkdir", "write_map", "fsync 3", "rename 1", "rename 2", "rmtree")


@pytest.mark.parametrize("killed_at", STEPS)
def test_killed_at_any_step_a_save_leaves_the_old_map_or_the_new_one(
    store: MapStore, monkeypatch: pytest.MonkeyPatch, killed_at: str
) -> None:
    store.save("home", floor(1.0))
    kill(monkeypatch, killed_at)
    with pytest.raises(Killed):
        store.save("home", floor(1.5))
    monkeypatch.undo()
    is_done = STEPS.index(killed_at) > STEPS.index("rename 2")
    assert store.names() == ("home",)
    assert store.load("home").is_same(floor(1.5 if is_done else 1.0))
    other = MapStore(store.folder)
    other.save("home", floor(1.7))
    assert other.load("home").is_same(floor(1.7))
    assert entries(store) == [".home.before", "home"]
    (store.folder / "home" / "map.pgm").unlink()
    before = MapStore(store.folder, lambda _: None).load("home")
    assert before.is_same(floor(1.5 if is_done else 1.0))


def test_killed_at_its_first_save_a_map_is_not_there(
    store: MapStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    kill(monkeypatch, "rename 1")
    with pytest.raises(Killed):
        store.save("home", floor())
    monkeypatch.undo()
    assert entries(store) == [".home.new"]
    assert store.names() == ()
    with pytest.raises(MapStoreError, match="no maps"):
        store.load("home")


@pytest.mark.parametrize("act", ["remove", "rename"])
def test_what_a_killed_save_left_can_be_removed_and_renamed(
    store: MapStore, monkeypatch: pytest.MonkeyPatch, act: str
) -> None:
    store.save("home", floor(1.0))
    kill(monkeypatch, "rename 2")
    with pytest.raises(Killed):
        store.save("home", floor(1.5))
    monkeypatch.undo()
    if act == "remove":
        store.remove("home")
        assert entries(store) == []
    else:
        store.rename("home", "house")
        assert entries(store) == ["house"]
        assert store.load("house").is_same(floor(1.0))


@pytest.mark.parametrize("killed_at", ["rmtree 1", "rmtree 2", "rename 1"])
def test_killed_while_it_is_removed_a_map_stands_behind_no_later_one(
    store: MapStore, monkeypatch: pytest.MonkeyPatch, killed_at: str
) -> None:
    for x in (1.0, 1.2):
        store.save("home", floor(x))
    kill(monkeypatch, killed_at)
    with pytest.raises(Killed):
        store.remove("home")
    monkeypatch.undo()
    if "home" in store.names():
        store.remove("home")
    assert store.names() == ()
    later = MapStore(store.folder, lambda _: None)
    later.save("home", floor(1.7))
    (store.folder / "home" / "map.pgm").unlink()
    with pytest.raises(MapStoreError, match=r"map\.pgm|expected a picture"):
        later.load("home")


def test_a_map_that_cannot_be_written_leaves_the_old_one(
    store: MapStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    store.save("home", floor(1.0))

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(map_store, "write_map", refuse)
    with pytest.raises(OSError, match="No space"):
        store.save("home", floor(1.5))
    assert entries(store) == ["home"]
    assert store.load("home").is_same(floor(1.0))


def kill(monkeypatch: pytest.MonkeyPatch, at: str) -> None:
    """Die instead of doing a step; nothing of what a living process would do after that is done."""
    step, _, number = at.partition(" ")
    owner: Any = {"mkdir": Path, "rename": Path, "rmtree": shutil, "fsync": os}.get(step, map_store)
    real = getattr(owner, step)
    rmtree = shutil.rmtree
    calls = 0

    def dying(*arguments: Any, **options: Any) -> Any:
        nonlocal calls
        if step == "mkdir" and not arguments[0].name.startswith("."):
            return real(*arguments, **options)
        calls += 1
        if calls == int(number or 1):
            raise Killed
        return real(*arguments, **options)

    def dead(path: Path, **options: Any) -> None:
        if calls < int(number or 1):
            rmtree(path, **options)

    if step != "rmtree":
        monkeypatch.setattr(shutil, "rmtree", dead)
    monkeypatch.setattr(owner, step, dying)
