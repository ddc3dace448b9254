"""Telling of trouble once as long as it lasts, and again only after another trouble or none."""

from __future__ import annotations

from collections.abc import Callable


class ToldOnce:
    """Tells a text to ``tell``, but not the same one twice in a row; an empty one tells nothing."""

    def __init__(self, tell: Callable[[str], object]) -> None:
        """Begin before the first text."""
        self._tell = tell
        self._told = ""

    def __call__(self, text: str) -> None:
        """Tell a text, if it is news; empty: what was told last is over."""
        if text and text != self._told:
            self._tell(text)
        self._told = text
