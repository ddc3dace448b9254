"""The runs of a campaign in the history of all runs: their figures, without recordings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from roomba.client.protocol import MissedFloor
from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.campaign.running.store import Row
from roomba.history.database import History
from roomba.history.run import CAMPAIGN, RunFigures, RunSource
from roomba.mission.cleaning.result import CleanOutcome

_KEY: Final = "key"
_AT_ONCE: Final = 200
"""Runs that are kept at a time: other writers wait for that."""


def keep_runs(history: History, campaign: Campaign, rows: Sequence[Row], repeat: str) -> int:
    """Keep the runs that are not in the history yet; return how many. Raises HistoryError."""
    there = history.configured(CAMPAIGN, _KEY)
    new = [row for row in rows if row["figures"] is not None and row["key"] not in there]
    for first in range(0, len(new), _AT_ONCE):
        batch = new[first : first + _AT_ONCE]
        history.add_all([figures_of(campaign, row, repeat) for row in batch])
    return len(new)


def figures_of(campaign: Campaign, row: Row, repeat: str) -> RunFigures:
    """Return a row as the history has it."""
    figures = row["figures"]
    variant = campaign.file.variants[row["variant"]]
    configuration = {
        "campaign": campaign.name,
        "variant": row["variant"],
        _KEY: row["key"],
        **variant.model_dump(mode="json", exclude_defaults=True),
    }
    return RunFigures(
        RunSource(CAMPAIGN, row["home"], row["seed"], repeat, configuration),
        "clean",
        row["began"],
        CleanOutcome[figures["outcome"]].value,
        figures["message"],
        figures["duration_s"],
        figures["covered_m2"],
        figures["coverable_m2"],
        figures["distance_m"],
        figures["turning_rad"],
        figures["dirt_g"],
        figures["energy_wh"] if figures["energy_wh"] is not None else math.nan,
        tuple(
            MissedFloor(miss["area_m2"], miss["x"], miss["y"], miss["room"], miss["reason"])
            for miss in figures["missed"]
        ),
    )
