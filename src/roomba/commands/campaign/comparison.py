"""Variants compared by pairs: the same home and seed with a variant, and with the baseline.

Homes differ much more from each other than variants do. The difference within a pair is free of
that, so that its mean is known much better than the difference of two means. Its interval is
Student's t for a mean of pairs (Student, "The probable error of a mean", Biometrika 6, 1908).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from roomba.arrays import Floats
from roomba.commands.campaign.running.measures import value_of
from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.campaign.running.store import Row

Pair = tuple[str, int]
"""Home and seed."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A variant's mean of a measure less the baseline's, over ``pairs`` of home and seed.

    ``home`` is one of the homes, or empty for all. From ``low`` to ``high`` is the confidence
    interval of the ``difference``; None with less than two pairs. ``left_out`` is the number of
    pairs without a value.
    """

    variant: str
    measure: str
    home: str
    pairs: int
    left_out: int
    baseline_mean: float
    variant_mean: float
    difference: float
    low: float | None
    high: float | None

    @property
    def is_told_apart(self) -> bool:
        """Whether zero difference lies outside the interval."""
        return self.low is not None and self.high is not None and not self.low <= 0.0 <= self.high

    @property
    def percent(self) -> tuple[float, float | None, float | None] | None:
        """Difference, low and high in % of the baseline's mean; None if that mean is 0."""
        mean = abs(self.baseline_mean)
        if mean < 1e-12:
            return None
        low, high = (None if end is None else 100.0 * end / mean for end in (self.low, self.high))
        return 100.0 * self.difference / mean, low, high

    def as_json(self) -> dict[str, Any]:
        """Return plain values."""
        return asdict(self)


def comparisons_of(campaign: Campaign, rows: Sequence[Row]) -> list[Comparison]:
    """Return the comparisons of each other variant with the baseline: over all homes, and each."""
    by_variant: dict[str, dict[Pair, Row]] = {name: {} for name in campaign.file.variants}
    for row in rows:
        by_variant[row["variant"]][row["home"], row["seed"]] = row
    base = by_variant.pop(campaign.baseline)
    homes = ("", *campaign.file.homes) if len(campaign.file.homes) > 1 else ("",)
    found = [
        compared(name, measure, home, (base, runs), campaign.file.confidence)
        for name, runs in by_variant.items()
        for measure in campaign.file.measures
        for home in homes
    ]
    return [each for each in found if each is not None]


def compared(
    variant: str,
    measure: str,
    home: str,
    runs: tuple[Mapping[Pair, Row], Mapping[Pair, Row]],
    confidence: float,
) -> Comparison | None:
    """Return the comparison of runs of the baseline and of a variant; None without a pair."""
    both = [pair for pair in runs[0] if pair in runs[1] and home in ("", pair[0])]
    values = [tuple(value_of(each[pair], measure) for each in runs) for pair in both]
    known = np.array([pair for pair in values if None not in pair], np.float64).reshape(-1, 2)
    if not len(known):
        return None
    low, high = interval_of(known[:, 1] - known[:, 0], confidence)
    baseline, other = known.mean(axis=0).tolist()
    return Comparison(
        variant,
        measure,
        home,
        len(known),
        len(both) - len(known),
        baseline,
        other,
        float((known[:, 1] - known[:, 0]).mean()),
        low,
        high,
    )


def interval_of(differences: Floats, confidence: float) -> tuple[float | None, float | None]:
    """Return the confidence interval of a mean; None of less than two values."""
    from scipy.stats import t  # a second, and only at the end

    count = len(differences)
    if count < 2:
        return None, None
    mean = float(differences.mean())
    error = float(differences.std(ddof=1)) / math.sqrt(count)
    reach = error * float(t.ppf(0.5 + 0.5 * confidence, count - 1))
    return mean - reach, mean + reach
