"""JSON of plain values, of bounded depth, with finite numbers alone."""

from __future__ import annotations

import json
import math
from typing import Any


def load_json(text: str) -> Any:
    """Return the values that a text holds; raises ValueError for what is none, and says why.

    Python's own reader takes NaN and infinity, and ends a program on a text that nests deeply.
    """
    try:
        return json.loads(text, parse_constant=_refuse, parse_float=_finite)
    except RecursionError:
        raise ValueError("expected JSON of a few levels, got one that nests too deeply") from None


def _refuse(constant: str) -> None:
    raise ValueError(f"expected finite numbers, got {constant}")


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"expected finite numbers, got {text[:40]}")
    return number
