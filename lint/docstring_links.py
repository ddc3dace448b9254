"""References of docstrings, written as Sphinx has them, as those of the site of the documents."""

from __future__ import annotations

import re
from typing import Any, Final

import griffe

_ROLE: Final = re.compile(r":(?:mod|class|func|meth|data|attr):`([~!.]*)([\w.]+)`")


class DocstringLinks(griffe.Extension):  # type: ignore[misc]
    """Names what a docstring refers to as code: the last part of it where it has a tilde."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Rewrite the docstring of a module, a class, a function or an attribute."""
        if obj.docstring is not None:
            obj.docstring.value = _ROLE.sub(_named, obj.docstring.value)


def _named(found: re.Match[str]) -> str:
    signs, name = found.groups()
    return f"`{name.rpartition('.')[2] if '~' in signs else name}`"
