"""What a campaign is to be, as its YAML file says it: homes, seeds, and variants of the robot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from roomba.clean_request import CleanRequest
from roomba.commands.campaign.running.measures import DEFAULT_MEASURES, MEASURES
from roomba.commands.options import MOST_SEED, UsageError
from roomba.commands.trials.numbers import check_numbers
from roomba.commands.trials.trial import MOST_THINGS, RANDOM, Trial
from roomba.configuration.body import BinCapacity
from roomba.configuration.frozen import (
    AtLeastOne,
    Count,
    Finite,
    Frozen,
    NotNegative,
    Ratio,
    load_config,
)
from roomba.configuration.sensors import lidar_models
from roomba.files.home_layer import DAY, MAP_NAME
from roomba.files.shipped import HOMES
from roomba.vocabulary import MOST_PASSES, CleanMode, FanLevel

MOST_RUNS: Final = 100_000

Seed = Annotated[int, Field(ge=0, le=MOST_SEED, strict=True)]
Name = Annotated[str, Field(min_length=1, max_length=80)]


class SeedRange(Frozen):
    """``count`` seeds from ``first`` on."""

    first: Seed = 0
    count: Annotated[int, Field(ge=1, le=MOST_RUNS, strict=True)]

    @model_validator(mode="after")
    def _last_is_a_seed(self) -> SeedRange:
        if (last := self.first + self.count - 1) > MOST_SEED:
            raise ValueError(
                f"expected first + count - 1 of at most {MOST_SEED}, got {last}; lower one of them"
            )
        return self


def _form_of_seeds(seeds: object) -> str:
    return "list" if isinstance(seeds, list | tuple) else "range"


Seeds = Annotated[
    Annotated[SeedRange, Tag("range")]
    | Annotated[tuple[Seed, ...], Field(min_length=1), Tag("list")],
    Discriminator(_form_of_seeds),
]
"""A tagged union, so that an error is reported for the form that the file uses."""


class Variant(Frozen):
    """What differs from the defaults; each name means the same as that option of ``sim``."""

    sensors: Literal["noisy", "ideal"] | None = None
    lidar: str | None = None
    wheels: Literal["factory", "worn"] | None = None
    things: Annotated[Count, Field(le=MOST_THINGS)] = 0
    shut_doors: bool = False
    battery: Ratio = 1.0
    bin: BinCapacity | None = None
    """g."""
    empty_after: Annotated[NotNegative, Field(le=DAY)] = 120.0
    """s."""
    turned: Finite = 0.0
    """Degrees, counter-clockwise."""
    mode: Literal["whole", "edges"] = "whole"
    passes: Annotated[AtLeastOne, Field(le=MOST_PASSES)] = 1
    fan: FanLevel = FanLevel.STANDARD
    numbers: dict[str, float | str] = Field(default_factory=dict)
    """Of the configuration, by names like ``mission.coverage.turning``."""
    stages: dict[str, str] = Field(default_factory=dict)
    """Stages of planning coverage by MODULE:FUNCTION, in the campaign's folder or installed."""

    def trial(self, home: str, seed: int, folder: Path) -> Trial:
        """Return one run of this variant."""
        return Trial(
            home=home,
            seed=seed,
            request=CleanRequest(CleanMode(self.mode), passes=self.passes, fan=self.fan),
            sensors=self.sensors,
            lidar=self.lidar,
            wheels=self.wheels,
            things=self.things,
            shut_doors=self.shut_doors,
            battery=self.battery,
            bin=self.bin,
            empties_bin_after=self.empty_after,
            turned=self.turned,
            numbers=tuple(sorted(self.numbers.items())),
            stages=tuple(sorted(self.stages.items())),
            code=folder if self.stages else None,
        )


class CampaignFile(Frozen):
    """The file: every home with every seed in every variant is a run."""

    homes: Annotated[tuple[Name, ...], Field(min_length=1)]
    seeds: Seeds
    variants: Annotated[dict[Name, Variant], Field(min_length=1)]
    baseline: str | None = None
    """The variant that the others are compared with; the first one by default."""
    measures: Annotated[tuple[str, ...], Field(min_length=1)] = DEFAULT_MEASURES
    confidence: Annotated[float, Field(ge=0.5, lt=1.0)] = 0.95

    @model_validator(mode="after")
    def _names_are_known(self) -> CampaignFile:
        if self.baseline is not None and self.baseline not in self.variants:
            raise ValueError(
                f"baseline: expected one of {', '.join(self.variants)}, got {self.baseline!r}"
            )
        unknown = [name for name in self.measures if name not in MEASURES]
        if unknown:
            raise ValueError(f"measures: expected {', '.join(MEASURES)}, got {unknown[0]!r}")
        for variant in self.variants.values():
            if variant.lidar is not None and variant.lidar not in lidar_models():
                raise ValueError(
                    f"lidar: expected {', '.join(lidar_models())}, got {variant.lidar!r}"
                )
        for what, names in (("homes", self.homes), ("seeds", self.all_seeds)):
            if len(set(names)) < len(names):
                raise ValueError(f"{what}: expected each once, got {names}")
        if self.count > MOST_RUNS:
            raise ValueError(f"expected at most {MOST_RUNS} runs, got {self.count}")
        return self

    @property
    def all_seeds(self) -> tuple[int, ...]:
        """The seeds one by one."""
        if isinstance(self.seeds, SeedRange):
            return tuple(range(self.seeds.first, self.seeds.first + self.seeds.count))
        return self.seeds

    @property
    def count(self) -> int:
        """How many runs there are."""
        return len(self.homes) * len(self.all_seeds) * len(self.variants)


@dataclass(frozen=True, slots=True)
class Campaign:
    """A campaign's file that was read; ``folder`` is where it lies."""

    name: str
    folder: Path
    file: CampaignFile

    @property
    def baseline(self) -> str:
        """The variant that the others are compared with."""
        return self.file.baseline or next(iter(self.file.variants))

    def place_of(self, home: str) -> str:
        """Return a home as a trial takes it: a name, or the path of its folder.

        Raises UsageError for a home that is not there.
        """
        if home == RANDOM or (HOMES / home / MAP_NAME).is_file():
            return home
        own = (self.folder / home).expanduser()
        if (own / MAP_NAME).is_file():
            return str(own)
        shipped = sorted(each.name for each in HOMES.iterdir() if (each / MAP_NAME).is_file())
        raise UsageError(
            f"homes: expected {RANDOM}, {', '.join(shipped)}, or a folder with {MAP_NAME}, "
            f"got {home!r}"
        )


def read_campaign(path: Path) -> Campaign:
    """Read a campaign's file; raises ConfigError and UsageError with the reason."""
    file = load_config(CampaignFile, path)
    for variant in file.variants.values():
        check_numbers(variant.numbers.items())
    return Campaign(path.stem, path.resolve().parent, file)
