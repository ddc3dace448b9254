"""Plain values that become JSON text once, however many viewers get it."""

from __future__ import annotations

import json
from typing import Any

Json = dict[str, Any]


class Told:
    """One message; its text is made when it is first needed."""

    def __init__(self, value: Json) -> None:
        """Take plain values, which must not be changed any more."""
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
