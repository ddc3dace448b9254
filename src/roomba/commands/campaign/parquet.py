"""The rows of a campaign as Parquet, for pandas, polars, DuckDB and others."""

from __future__ import annotations

import importlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from roomba.commands.campaign.running.runs import program
from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.campaign.running.store import Row
from roomba.files.atomic import write_whole

_PLAIN: Final = ("home", "seed", "variant", "failure", "where", "began", "key")
_TEXTS: Final = ("outcome", "message", "calibration")
_COUNTS: Final = ("plans", "bins_emptied", "hits")
_NUMBERS: Final = (
    "duration_s", "wall_s", "planning_s", "distance_m", "turning_rad", "energy_wh", "dirt_g",
    "coverable_m2", "covered_m2", "fraction", "path_ratio", "wheels_error",
    "calibrated_wheels_error", "odometry_error", "calibrated_error",
)  # fmt: skip


def why_no_parquet() -> str:
    """Return why the extra that writes Parquet cannot be used; nothing where it can."""
    try:
        importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        return str(error)
    return ""


def write_parquet(path: Path, campaign: Campaign, rows: Sequence[Row]) -> None:
    """Write a row for each run, atomically; raises OSError.

    Columns are named as in the JSON of ``sim``; those of a run without figures are null.
    """
    import pyarrow as pa
    from pyarrow import parquet

    missed = pa.list_(
        pa.struct(
            [(name, pa.float64()) for name in ("area_m2", "x", "y")]
            + [(name, pa.string()) for name in ("room", "reason")]
        )
    )
    columns: list[tuple[str, Any]] = [
        ("home", pa.string()),
        ("seed", pa.int64()),
        ("variant", pa.string()),
        *((name, pa.string()) for name in _TEXTS),
        ("docked", pa.bool_()),
        *((name, pa.float64()) for name in _NUMBERS),
        *((name, pa.int64()) for name in _COUNTS),
        ("missed", missed),
        ("failure", pa.string()),
        ("where", pa.string()),
        ("began", pa.float64()),
        ("key", pa.string()),
    ]
    told = {
        "campaign": campaign.name,
        "baseline": campaign.baseline,
        "file": json.dumps(campaign.file.model_dump(mode="json")),
        "program": program(),
    }
    schema = pa.schema(columns, metadata=told)
    flat = [_flat(row, [name for name, _ in columns]) for row in rows]
    sink = pa.BufferOutputStream()
    parquet.write_table(pa.Table.from_pylist(flat, schema=schema), sink)
    write_whole(path, sink.getvalue().to_pybytes())


def _flat(row: Row, names: Sequence[str]) -> dict[str, Any]:
    figures = row["figures"] or {}
    return {name: row[name] if name in _PLAIN else figures.get(name) for name in names}
