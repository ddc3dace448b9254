"""Several maps of the robot's own, one for each floor, by name, in a folder.

A map is replaced atomically: it is written beside the old one, then renamed. A writer that is
killed in between leaves the old map or the new one. The map that was replaced is kept, and is used
when the newer one turns out to be damaged. Symbolic links in the folder are not followed.
"""

from __future__ import annotations

import difflib
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Final

from roomba.files.atomic import make_private
from roomba.storage.map_folder import MapStoreError, StoredMap, read_map, write_map
from roomba.vocabulary import is_readable

__all__ = ["MapStore", "MapStoreError", "StoredMap"]

LONGEST_NAME: Final = 50
"""Characters: with what is added while it is replaced the name fits any file system."""
_FORBIDDEN: Final = frozenset("/\\.")
_NEW: Final = "new"
_OLD: Final = "old"
_GONE: Final = "gone"
_BEFORE: Final = "before"
_DAMAGED: Final = "damaged"
"""Ends of hidden folders: being written, moved out of the way, being removed, the map that was
replaced, and one that could not be read."""


class MapStore:
    """Maps by name, each a folder of ``folder``. One writer at a time.

    All methods raise MapStoreError for an invalid or unknown name, and OSError when the disk
    refuses.
    """

    def __init__(self, folder: Path, tell: Callable[[str], object] | None = None) -> None:
        """``folder`` need not be there yet: it is made when the first map is saved.

        ``tell`` is told in a sentence when a damaged map was set aside; without ``tell`` no map is
        set aside.
        """
        self.folder, self._tell = folder, tell

    def names(self) -> tuple[str, ...]:
        """Return the names of all maps, sorted; those of broken ones, too."""
        if not self.folder.is_dir():
            return ()
        entries = (entry for entry in self.folder.iterdir() if not entry.is_symlink())
        found = {_name_of(entry) for entry in entries if entry.is_dir()}
        return tuple(sorted(name for name in found if name))

    def save(self, name: str, stored: StoredMap) -> None:
        """Store a map; one of the same name is replaced.

        Raises MapStoreError for a map that files cannot hold; the old one stays then.
        """
        _check_name(name)
        make_private(self.folder)
        self._tidy_up(name)
        unfinished, place = self._beside(name, _NEW), self.folder / name
        make_private(unfinished)
        try:
            write_map(stored, unfinished)
        except BaseException:
            shutil.rmtree(unfinished, ignore_errors=True)
            raise
        if place.is_symlink():
            place.unlink()
        if place.exists():
            # Until the next line is done, the old map is found under its other name.
            place.rename(self._beside(name, _OLD))
        unfinished.rename(place)
        _wait_for_disk(self.folder)
        self._keep_before(name)

    def require(self, name: str) -> None:
        """Raise MapStoreError, which says what maps there are, for a name that none has."""
        self._folder_of(name)

    def load(self, name: str) -> StoredMap:
        """Return a map. Raises MapStoreError, which names the file, for one that is broken.

        If the store has ``tell``, the map that the broken one replaced takes its place, if there is
        one.
        """
        folder = self._folder_of(name)
        try:
            return read_map(folder)
        except MapStoreError as error:
            before = self._beside(name, _BEFORE)
            if self._tell is None or not _is_folder(before):
                raise
            found = read_map(before)
            damaged = self._beside(name, _DAMAGED)
            shutil.rmtree(damaged, ignore_errors=True)
            folder.rename(damaged)
            before.rename(self.folder / name)
            _wait_for_disk(self.folder)
            self._tell(f"{error}; it is set aside as {damaged.name}, and the one before is used")
            return found

    def remove(self, name: str) -> None:
        """Remove a map, also a broken one."""
        self._folder_of(name)
        self._tidy_up(name)
        # The generations before go first: they must not stand behind a later map of this name.
        for end in (_BEFORE, _DAMAGED):
            if _is_folder(self._beside(name, end)):
                shutil.rmtree(self._beside(name, end))
        (self.folder / name).rename(self._beside(name, _GONE))
        _wait_for_disk(self.folder)
        shutil.rmtree(self._beside(name, _GONE))

    def rename(self, name: str, new_name: str) -> None:
        """Give a map another name; raises MapStoreError if another map has it."""
        _check_name(new_name)
        self._folder_of(name)
        if new_name == name:
            return
        if new_name in self.names():
            raise MapStoreError(
                f"expected a name that no map has, got {new_name!r}; choose another one, or remove "
                "that map first"
            )
        self._tidy_up(name)
        self._tidy_up(new_name)
        (self.folder / name).rename(self.folder / new_name)
        if _is_folder(self._beside(name, _BEFORE)):
            shutil.rmtree(self._beside(new_name, _BEFORE), ignore_errors=True)
            self._beside(name, _BEFORE).rename(self._beside(new_name, _BEFORE))
        _wait_for_disk(self.folder)

    def _folder_of(self, name: str) -> Path:
        """Return the folder in which a map is whole, also when its writer was killed."""
        _check_name(name)
        for path in (self.folder / name, self._beside(name, _OLD)):
            if _is_folder(path):
                return path
        near = difflib.get_close_matches(name, self.names(), 1)
        known = ", ".join(repr(each) for each in self.names()) or "no maps"
        advice = f"did you mean {near[0]!r}?" if near else "choose one of them, or map this floor"
        raise MapStoreError(f"{self.folder}: expected one of {known}, got {name!r}; {advice}")

    def _tidy_up(self, name: str) -> None:
        """Complete or undo what a killed writer began."""
        place, old = self.folder / name, self._beside(name, _OLD)
        if _is_folder(old) and not place.exists():
            old.rename(place)
        elif _is_folder(old):
            self._keep_before(name)
        for end in (_NEW, _OLD, _GONE):
            beside = self._beside(name, end)
            if beside.is_symlink():
                # Links are not followed: what they lead to is no map of this store.
                beside.unlink()
            elif beside.is_dir():
                shutil.rmtree(beside)

    def _keep_before(self, name: str) -> None:
        """Keep the map that was replaced, if it is whole, instead of the one from before it."""
        old = self._beside(name, _OLD)
        if not _is_folder(old):
            return
        try:
            read_map(old)
        except MapStoreError:
            shutil.rmtree(old, ignore_errors=True)
            return
        shutil.rmtree(self._beside(name, _BEFORE), ignore_errors=True)
        old.rename(self._beside(name, _BEFORE))

    def _beside(self, name: str, end: str) -> Path:
        """Return a hidden folder on the same file system, where a rename is atomic."""
        return self.folder / f".{name}.{end}"


def _check_name(name: str) -> None:
    """Raise MapStoreError for a name that some file system does not allow."""
    is_good = (
        0 < len(name) <= LONGEST_NAME
        and name == name.strip()
        and is_readable(name)
        and not _FORBIDDEN & set(name)
    )
    if not is_good:
        raise MapStoreError(
            f"expected a map's name of 1 to {LONGEST_NAME} characters without slashes and dots, "
            f"and no blanks around it, got {name[: 2 * LONGEST_NAME]!r}; choose another name"
        )


def _name_of(entry: Path) -> str:
    """Return the name of the map that a folder is of; empty for what is no map's."""
    if not entry.name.startswith("."):
        return entry.name
    name, _, end = entry.name[1:].rpartition(".")
    return name if end == _OLD else ""


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _wait_for_disk(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
