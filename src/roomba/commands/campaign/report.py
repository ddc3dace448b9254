"""What came of a campaign, as tables for people and plain values for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from rich.table import Table

from roomba.commands.campaign.comparison import Comparison
from roomba.commands.campaign.running.measures import MEASURES, is_completed, value_of
from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.campaign.running.store import Row

VERSION: Final = 1
_SHOWN: Final = 8
"""The most failures that are listed one by one."""


def tables_of(
    campaign: Campaign, rows: Sequence[Row], comparisons: Sequence[Comparison]
) -> list[Table]:
    """Return the table of all variants, and one of each variant beside the baseline."""
    others = [name for name in campaign.file.variants if name != campaign.baseline]
    tables = [_means_table(campaign, rows)]
    for name in others:
        of_variant = [each for each in comparisons if each.variant == name]
        if of_variant:
            tables.append(_comparison_table(campaign, name, of_variant))
    return tables


def failure_lines(rows: Sequence[Row], lost: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return a line for each run without figures: which one, and why."""
    failed = [(_name_of(row), str(row["failure"])) for row in rows if row["figures"] is None]
    lines = [*failed, *lost]
    if len(lines) > _SHOWN:
        return [*lines[:_SHOWN], ("and", f"{len(lines) - _SHOWN} others")]
    return lines


def as_json(
    campaign: Campaign,
    rows: Sequence[Row],
    comparisons: Sequence[Comparison],
    lost: Sequence[tuple[str, str]],
) -> dict[str, Any]:
    """Return all of a campaign as plain values."""
    return {
        "version": VERSION,
        "campaign": campaign.name,
        "baseline": campaign.baseline,
        "confidence": campaign.file.confidence,
        "runs": list(rows),
        "lost": [{"run": name, "reason": reason} for name, reason in lost],
        "comparisons": [each.as_json() for each in comparisons],
    }


def _name_of(row: Row) -> str:
    return f"{row['home']}, seed {row['seed']}, {row['variant']}"


def _means_table(campaign: Campaign, rows: Sequence[Row]) -> Table:
    """Return the table of means: a row for each measure, a column for each variant."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column("mean of all runs", style="bold", no_wrap=True)
    by_variant: dict[str, list[Row]] = {name: [] for name in campaign.file.variants}
    for row in rows:
        by_variant[row["variant"]].append(row)
    for name in by_variant:
        table.add_column(name, justify="right")
    counts = [
        f"{sum(row['figures'] is not None and is_completed(row['figures']) for row in runs)}"
        f" of {len(runs)}"
        for runs in by_variant.values()
    ]
    table.add_row("completed and docked", *counts)
    for measure in campaign.file.measures:
        told = MEASURES[measure]
        cells = []
        for runs in by_variant.values():
            known = [value for row in runs if (value := value_of(row, measure)) is not None]
            mean = sum(known) / len(known) if known else None
            cells.append("" if mean is None else f"{told.scale * mean:.{told.digits}f}")
        table.add_row(told.label, *cells)
    return table


def _comparison_table(campaign: Campaign, name: str, all_of_it: Sequence[Comparison]) -> Table:
    share = f"{100.0 * campaign.file.confidence:g} %"
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column(f"{name} less {campaign.baseline}", style="bold", no_wrap=True)
    for column in ("home", "pairs", "difference", f"{share} from", "to", ""):
        table.add_column(column, justify="left" if column in ("home", "") else "right")
    for each in all_of_it:
        told = MEASURES[each.measure]
        ends = [
            "" if end is None else f"{told.scale * end:+.{told.digits}f}"
            for end in (each.low, each.high)
        ]
        table.add_row(
            told.label if not each.home else "",
            each.home or "all",
            f"{each.pairs}" + (f" (-{each.left_out})" if each.left_out else ""),
            f"{told.scale * each.difference:+.{told.digits}f}",
            *ends,
            "differs" if each.is_told_apart else "",
        )
    return table
