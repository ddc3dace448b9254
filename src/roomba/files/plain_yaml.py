"""YAML of plain values, of bounded depth and size: no file can hang or end the program.

libyaml's parser is five times as fast as PyYAML's own, but ends the program on a file that nests
deeply. So its events are counted first, which takes no recursion.
"""

from __future__ import annotations

from typing import Any, Final

import yaml
from yaml.composer import Composer
from yaml.constructor import SafeConstructor
from yaml.parser import Parser
from yaml.reader import Reader
from yaml.resolver import Resolver
from yaml.scanner import Scanner

LONGEST: Final = 8_000_000
"""Characters of a file; the zones and rooms of the largest homes need a tenth."""
DEEPEST: Final = 32
"""Lists and mappings inside one another."""
MOST_VALUES: Final = 500_000
"""Values of a file, those that aliases repeat counted each time."""


class _PurePython(Reader, Scanner, Parser, Composer):
    """What stands for libyaml's parser where PyYAML was built without it."""

    def __init__(self, text: str) -> None:
        Reader.__init__(self, text)
        Scanner.__init__(self)
        Parser.__init__(self)
        Composer.__init__(self)


_Parser: Any = vars(yaml.cyaml)["CParser"] if yaml.__with_libyaml__ else _PurePython


class _Loader(_Parser, SafeConstructor, Resolver):  # type: ignore[misc]
    """Made of the parts of ``yaml.SafeLoader``, to which ROS adds constructors that run code."""

    def __init__(self, text: str) -> None:
        _Parser.__init__(self, text)
        SafeConstructor.__init__(self)
        Resolver.__init__(self)


def load_yaml(text: str) -> Any:
    """Return the plain values that a text holds; raises ``yaml.YAMLError``."""
    return load_with_nodes(text)[0]


def load_with_nodes(text: str) -> tuple[Any, yaml.Node | None]:
    """Return the values, and the tree that knows in which line each one stands.

    Raises ``yaml.YAMLError``, whose ``problem_mark`` tells the line where it is known.
    """
    if len(text) > LONGEST:
        raise yaml.MarkedYAMLError(
            problem=f"expected at most {LONGEST} characters, got {len(text)}"
        )
    _refuse_bombs(text)
    loader = _Loader(text)
    root = loader.get_single_node()
    try:
        return None if root is None else loader.construct_document(root), root
    except (ValueError, TypeError, OverflowError) as error:  # such as the 40th of May
        raise yaml.MarkedYAMLError(problem=f"expected plain values: {error}") from error


def _refuse_bombs(text: str) -> None:
    """Require few levels and few values, with those that aliases stand for.

    An alias stands for all that its anchor holds: nine aliases of nine aliases, nine levels deep,
    are a file of 300 characters and half a billion values.
    """
    sizes: dict[str, int] = {}
    open_ones: list[tuple[str | None, int]] = []
    values, loader = 0, _Loader(text)
    while loader.check_event():
        event = loader.get_event()
        if isinstance(event, yaml.CollectionStartEvent):
            open_ones.append((event.anchor, values))
            values += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            anchor, before = open_ones.pop()
            if anchor is not None:
                sizes[anchor] = values - before
        elif isinstance(event, yaml.AliasEvent):
            values += sizes.get(str(event.anchor), 1)
        elif isinstance(event, yaml.ScalarEvent):
            values += 1
        if len(open_ones) > DEEPEST:
            raise _refused(event, f"at most {DEEPEST} levels")
        if values > MOST_VALUES:
            raise _refused(event, f"at most {MOST_VALUES} values, with those that aliases repeat")


def _refused(event: Any, expected: str) -> yaml.YAMLError:
    problem = f"expected {expected}, got more"
    return yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)
