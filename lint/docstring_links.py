"""Turns references in docstrings, in Sphinx's notation, into code for the site of the documents."""

from __future__ import annotations

import re
from typing import Any, Final

import griffe

_ROLE: Final = re.compile(r":(?:mod|class|func|meth|data|attr):`([~!.]*)([\w.]+)`")


class DocstringLinks(griffe.Extension):  # type: ignore[misc]
    """Replaces each reference by its name as code; with a tilde, by the name's last part."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Rewrite the docstring of a module, a class, a function or an attribute."""
        if obj.docstring is not None:
            obj.docstring.value = _ROLE.sub(_named, obj.docstring.value)


def _named(found: re.Match[str]) -> str:
    signs, name = found.groups()
    return f"`{name.rpartition('.')[2] if '~' in signs else name}`"
