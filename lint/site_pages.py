"""The pages of the site of the documents, and where their links lead.

The documents are written for a checkout, with links from file to file. On the site some of these
files are pages, and pictures are copied; other files are named without a link.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, TypeAlias

Entry: TypeAlias = str | dict[str, Any]

_NAMES: Final = {
    "README.md": "start",
    "CONTRIBUTING.md": "contributing",
    "SECURITY.md": "security",
    "benchmarks/README.md": "benchmarks",
}
_MEASURED: Final = Path(__file__).resolve().parent.parent / "benchmarks" / "measured"
OUTSIDE: Final = {path: f"{name}.md" for path, name in _NAMES.items()} | {
    f"benchmarks/measured/{page.name}": f"measured/{page.name}"
    for page in sorted(_MEASURED.glob("*.md"))
}
"""Pages of the site that do not lie in ``docs``: their files, and what they are on the site."""
DECISIONS: Final = posixpath.join("adr", "README.md")
API: Final = "api"
_DOCUMENTS: Final = "docs"
_LINK: Final = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
_CODE: Final = re.compile(r"^```(?s:.*?)^```$|^(?: {4}.*\n)+", re.MULTILINE)


def anchor_of(heading: str, separator: str = "-") -> str:
    """Return the name that GitHub gives to a heading, by which the documents link to it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", separator)


def place_of(path: str) -> str | None:
    """Return where a file of the repository is on the site, None if it is not there."""
    if path in OUTSIDE:
        return OUTSIDE[path]
    if posixpath.normpath(path) == f"{_DOCUMENTS}/adr":
        return DECISIONS
    folder, _, rest = path.partition("/")
    is_page = Path(path).suffix in {".md", ".png", ".webp", ".jpg", ".py", ".yaml"}
    return rest if folder == _DOCUMENTS and is_page else None


def file_of(place: str) -> str:
    """Return the file of the repository that a page of the site is made of."""
    outside = {page: path for path, page in OUTSIDE.items()}
    return outside.get(place, f"{_DOCUMENTS}/{place}")


def for_site(text: str, place: str) -> str:
    """Return the text of a page with its links as they are on the site; code stays as it is."""
    file = file_of(place)
    parts, end = [], 0
    for code in _CODE.finditer(text):
        parts += [_with_links(text[end : code.start()], file, place), code[0]]
        end = code.end()
    return "".join([*parts, _with_links(text[end:], file, place)])


def _with_links(text: str, file: str, place: str) -> str:
    def rewritten(link: re.Match[str]) -> str:
        picture, words, target = link.groups()
        words = _with_links(words, file, place)
        path, sign, anchor = target.partition("#")
        if "://" in target or not path:
            return f"{picture}[{words}]({target})"
        leads_to = place_of(posixpath.normpath(posixpath.join(posixpath.dirname(file), path)))
        if leads_to is None:
            return words
        relative = posixpath.relpath(leads_to, posixpath.dirname(place) or ".")
        return f"{picture}[{words}]({relative}{sign}{anchor})"

    return _LINK.sub(rewritten, text)


def pages_of(navigation: Iterable[Entry]) -> list[str]:
    """Return the pages that a navigation names, in order."""
    found: list[str] = []
    for entry in navigation:
        if isinstance(entry, str):
            found.append(entry)
            continue
        for below in entry.values():
            found += [below] if isinstance(below, str) else pages_of(below)
    return found


def whole_navigation(
    navigation: Sequence[Entry], decisions: Sequence[str], api: Mapping[str, str]
) -> list[Entry]:
    """Return the navigation with a line for each decision, and for each page of the API.

    ``decisions`` are names of files in ``docs/adr``; ``api`` has titles and pages.
    """
    filled: dict[str, list[Any]] = {
        DECISIONS: [DECISIONS, *(f"adr/{name}" for name in sorted(decisions))],
        f"{API}/": [{title: page} for title, page in api.items()],
    }
    return [_filled(entry, filled) for entry in navigation]


def _filled(entry: Entry, filled: Mapping[str, list[Any]]) -> Entry:
    if isinstance(entry, str):
        return entry
    whole: dict[str, Any] = {}
    for title, below in entry.items():
        if isinstance(below, str):
            whole[title] = filled.get(below, below)
        else:
            whole[title] = [_filled(each, filled) for each in below]
    return whole


def decisions_page(titles: Mapping[str, str]) -> str:
    """Return the page that lists the decisions; ``titles`` by the names of their files."""
    lines = [f"{name[:4]}. [{title}]({name})  " for name, title in sorted(titles.items())]
    return "\n".join(["# Decisions", "", "Each with its reason, one a page.", "", *lines, ""])


def title_of(text: str) -> str:
    """Return the first heading of a page."""
    heading = re.search(r"^# (.+)$", text, re.MULTILINE)
    if heading is None:
        raise ValueError("expected a page with a heading of the first level, found none")
    return heading[1]


def api_pages(sources: Path, folders: Iterable[str]) -> dict[str, str]:
    """Return the text of a page for each folder of modules, by the folder's dotted name.

    ``folders`` are paths below ``sources``; modules whose names begin with ``_`` are left out.
    """
    pages = {}
    for folder in sorted(folders):
        package = folder.replace("/", ".")
        modules = sorted(
            path.stem for path in (sources / folder).glob("*.py") if not path.stem.startswith("_")
        )
        if modules:
            named = [f"::: {package}.{module}" for module in modules]
            pages[package] = "\n\n".join([f"# {package}", f"::: {package}", *named, ""])
    return pages
