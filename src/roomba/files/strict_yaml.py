"""Reads YAML strictly, and says in which line of the file something is wrong."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from pydantic import BaseModel, ValidationError
from yaml import MappingNode, Node, ScalarNode, SequenceNode, YAMLError

from roomba.errors import HomeError
from roomba.files.bounded import read_bytes
from roomba.files.kept import SealError, unsealed
from roomba.files.plain_yaml import load_with_nodes

Location = tuple[int | str, ...]
_Model = TypeVar("_Model", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class YamlFile:
    """A file's content as plain values, and the tree that knows where each one stands."""

    path: Path
    data: Any
    root: Node | None

    def error(self, location: Location, reason: str) -> HomeError:
        """Return (not raise) the error for the value at ``location``: keys and indices.

        Of a location that is not there (a missing key) the nearest enclosing value gives the line.
        """
        return HomeError(f"{self.path}:{self._line_of(location)}: {reason}")

    def validated(self, model: type[_Model]) -> _Model:
        """Return the content as a model; raises :class:`HomeError` with line, reason and value."""
        try:
            return model.model_validate(self.data)
        except ValidationError as error:
            first = error.errors()[0]
            known = _keys_at(model, first["loc"][:-1])
            raise self.error(first["loc"], _reason(dict(first), known)) from None

    def _line_of(self, location: Location) -> int:
        node = self.root
        if node is None:
            return 1
        line = node.start_mark.line
        for step in location:
            found = _child(node, step)
            if found is None:
                break
            key, node = found
            line = key.start_mark.line
        return int(line) + 1


def read_yaml(path: Path) -> YamlFile:
    """Read a YAML file; raises :class:`HomeError` if it cannot be read or is not a mapping."""
    try:
        content = read_bytes(path)
        unsealed(content)
        # The seal is a comment, and lines are counted with it.
        text = content.decode("utf-8")
    except SealError as error:
        raise HomeError(f"{path}: {error}") from error
    except OSError as error:
        raise HomeError(f"{path}: cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise HomeError(
            f"{path}: expected UTF-8 text, got other bytes; save it as UTF-8"
        ) from error
    try:
        data, root = load_with_nodes(text)
    except YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark is not None else 1
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise HomeError(f"{path}:{line}: expected YAML, got something else: {problem}") from error
    file = YamlFile(path, data, root)
    if repeated := repeated_key(root):
        raise HomeError(f"{path}:{repeated.told}")
    if not isinstance(data, dict):
        raise file.error((), f"expected keys and values (`key: value`), got {_shown(data)}")
    return file


class RepeatedKey(NamedTuple):
    """A key that its mapping has twice, and the line of the second one."""

    line: int
    name: str

    @property
    def told(self) -> str:
        """Its line and what to do, as "LINE: TEXT"."""
        return f"{self.line}: expected each key once, got {self.name!r} again; remove one of them"


def repeated_key(root: Node | None) -> RepeatedKey | None:
    """Return a key that its mapping has twice, None where each is there once.

    YAML lets the last of the two win in silence.
    """
    seen: set[int] = set()
    left = [] if root is None else [root]
    while left:
        node = left.pop()
        if id(node) in seen:  # an alias stands for it as well
            continue
        seen.add(id(node))
        if isinstance(node, SequenceNode):
            left += node.value
        if isinstance(node, MappingNode):
            left += [value for _, value in node.value]
            keys: set[str] = set()
            for key in [key for key, _ in node.value if isinstance(key, ScalarNode)]:
                if key.value in keys:
                    return RepeatedKey(key.start_mark.line + 1, key.value)
                keys.add(key.value)
    return None


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return what to do about an unknown word: the nearest known one, or all of them."""
    choices = sorted(known)
    near = difflib.get_close_matches(word, choices, n=1, cutoff=0.5)
    return f"did you mean {near[0]!r}?" if near else f"known are: {', '.join(choices)}"


def _child(node: Node, step: int | str) -> tuple[Node, Node] | None:
    """Return the node where a child begins (its key, or itself in a list), and the child."""
    if isinstance(node, MappingNode):
        for key, value in node.value:
            if isinstance(key, ScalarNode) and key.value == str(step):
                return key, value
    if isinstance(node, SequenceNode) and isinstance(step, int) and step < len(node.value):
        return node.value[step], node.value[step]
    return None


def _reason(error: dict[str, Any], known: list[str]) -> str:
    """Turn pydantic's first error into: what was expected, what came, what to do."""
    name = ".".join(str(part) for part in error["loc"])
    key = str(error["loc"][-1]) if error["loc"] else ""
    if error["type"] == "extra_forbidden":
        return f"expected a known key, got {key!r}; {suggestion(key, known)}"
    if error["type"] == "missing":
        return f"expected {key!r} here, got nothing; add it"
    message = str(error["msg"]).removeprefix("Value error, ").removeprefix("Assertion failed, ")
    message = message.replace("Input should be", "expected")
    message = message[:1].lower() + message[1:]
    return f"{name}: {message}; got {_shown(error['input'])}; correct it"


def _keys_at(model: type[BaseModel], location: Location) -> list[str]:
    """Return the keys that the model takes at a location, for the suggestion of a spelling."""
    current: Any = model
    for step in location:
        if isinstance(step, int):
            continue
        field = current.model_fields.get(step) if hasattr(current, "model_fields") else None
        if field is None:
            return []
        current = _model_in(field.annotation)
    return list(current.model_fields) if hasattr(current, "model_fields") else []


def _model_in(annotation: Any) -> Any:
    """Return the model inside ``list[Model]``, ``Model | None`` and the like."""
    if hasattr(annotation, "model_fields"):
        return annotation
    for part in getattr(annotation, "__args__", ()):
        found = _model_in(part)
        if found is not None:
            return found
    return None


def _shown(value: Any) -> str:
    text = "nothing" if value is None else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
