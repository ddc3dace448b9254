"""The runs of a campaign; each has a key, and runs with the same key are the same bit for bit."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import json
import socket
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.options import UsageError
from roomba.commands.trials.stages import files_of_stage
from roomba.commands.trials.trial import RANDOM, Trial
from roomba.compiled_sources import PACKAGE, Sources
from roomba.errors import RoombaError
from roomba.files.bounded import read_bytes
from roomba.files.home_layer import files_of_home
from roomba.files.occupancy_map import load_map
from roomba.files.shipped import CONFIGURATION, HOMES
from roomba.mission.cleaning.checkpoint import request_values
from roomba.storage.map_bound import map_digest

_ENTRY: Final = PACKAGE / "commands" / "trials" / "runs.py"
"""The program of a run is this file and all that it imports."""
_COMPUTE: Final = ("numpy", "numba")
"""Packages whose other versions may change numbers in the last bit."""
_MOST_BYTES: Final = 64_000_000
"""Of one file of a home."""
_DIGITS: Final = 24
"""Of a key."""


class OtherMachineError(RoombaError):
    """This machine would not make the same run: its program or its files differ."""


@dataclass(frozen=True, slots=True)
class CampaignRun:
    """One run, as it is sent to a worker.

    ``home`` is the home's name in the campaign's file. The run must be made with a program of the
    hash ``program``, and with files of home and stages of the hash ``content``.
    """

    home: str
    seed: int
    variant: str
    trial: Trial
    program: str
    content: str
    key: str


def runs_of(campaign: Campaign) -> list[CampaignRun]:
    """Return the runs; runs of the same home and seed follow one another, to be compared."""
    file = campaign.file
    contents: dict[tuple[str, tuple[tuple[str, str], ...]], str] = {}
    runs = []
    for home in file.homes:
        place = campaign.place_of(home)
        for seed in file.all_seeds:
            for name, variant in file.variants.items():
                trial = variant.trial(place, seed, campaign.folder)
                made_of = (place, trial.stages)
                if made_of not in contents:
                    contents[made_of] = content_of(trial)
                content = contents[made_of]
                key = _key_of(home, trial, content)
                runs.append(CampaignRun(home, seed, name, trial, program(), content, key))
    return runs


def require_same(run: CampaignRun) -> None:
    """Raise OtherMachineError where this machine would not do the same run."""
    here = f"the worker on {socket.gethostname()}"
    if program() != run.program:
        raise OtherMachineError(
            f"{here}: expected the program, numpy and numba of the machine that the campaign was "
            f"started on ({run.program}), got others ({program()}); start it from the same "
            "checkout, or the same wheel"
        )
    try:
        content = content_of(run.trial)
    except (RoombaError, OSError) as error:
        raise OtherMachineError(f"{here}: {error}") from error
    if content != run.content:
        raise OtherMachineError(
            f"{here}: expected home {run.home} and the stages of variant {run.variant} as on the "
            "machine that the campaign was started on, got other files; copy them"
        )


def content_of(trial: Trial) -> str:
    """Return a hash of the files of a trial: its home's, and those with its stages.

    The home's map is hashed as it is read: its picture may lie in another folder. Raises HomeError
    and UsageError.
    """
    files: list[tuple[str, Path]] = []
    occupancy = ""
    if trial.home != RANDOM:
        map_path, _ = files_of_home(trial.home, HOMES)
        occupancy = map_digest(load_map(map_path))
        files += [(path.name, path) for path in sorted(map_path.parent.iterdir()) if path.is_file()]
    for name, stage in trial.stages:
        found = files_of_stage(name, stage, trial.code)
        if not found:
            raise UsageError(f"stages: {name}: expected a module with a file, got {stage!r}")
        files += [(f"{stage} {file}", path) for file, path in sorted(found.items())]
    return _hash_of(f"{occupancy}\n{_hash_of_files(files)}")


@functools.cache
def program() -> str:
    """Return a hash of all that determines a run, besides its trial: sources, numbers, packages.

    Changes of other parts of the program, such as the page, do not change the hash.
    """
    sources = Sources(PACKAGE).key(_ENTRY)
    files = [(path.name, path) for path in sorted(CONFIGURATION.rglob("*.yaml"))]
    packages = [f"{name} {importlib.metadata.version(name)}" for name in _COMPUTE]
    return _hash_of("\n".join([sources, _hash_of_files(files), *packages]))


def _key_of(home: str, trial: Trial, content: str) -> str:
    values: dict[str, Any] = asdict(trial) | {"request": request_values(trial.request)}
    # Where the files lie does not matter, only what is in them.
    values |= {"home": home, "code": None, "content": content, "program": program()}
    return _hash_of(json.dumps(values, sort_keys=True))


def _hash_of_files(files: Iterable[tuple[str, Path]]) -> str:
    told = [
        f"{name} {hashlib.sha256(read_bytes(path, _MOST_BYTES)).hexdigest()}"
        for name, path in files
    ]
    return _hash_of("\n".join(told))


def _hash_of(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:_DIGITS]
