"""What is told to many: plain values that become text once, however many get it."""

from __future__ import annotations

import json
from typing import Any

Json = dict[str, Any]


class Told:
    """One message; the first who takes its text makes it."""

    def __init__(self, value: Json) -> None:
        """Tell plain values, which are not changed any more."""
        self.value = value
        self._text: str | None = None

    @property
    def text(self) -> str:
        """The values as JSON; raises ValueError for numbers that are not finite."""
        if self._text is None:
            self._text = text_of(self.value)
        return self._text


def text_of(value: Json) -> str:
    """Return values as JSON without spaces; raises ValueError for numbers that are not finite."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False)
