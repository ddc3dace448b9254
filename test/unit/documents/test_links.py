"""Every document, file and section that a text of the repository names is there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def files(folder: Path = ROOT) -> Iterator[Path]:
    """Yield all files that are not hidden, as seen from the repository."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_dir():
            yield from files(path)
        else:
            yield path.relative_to(ROOT)


FILES = list(files())
PAGES = [path for path in FILES if path.suffix == ".md"]
TEXTS = [
    path
    for path in FILES
    if path.suffix in {".action", ".launch", ".md", ".msg", ".py", ".rst", ".sh", ".srv", ".toml"}
    or path.suffix in {".txt", ".yaml"}
    or path.name == "roomba"
]
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED_FILE = re.compile(
    r"(?<![\w./~:>-])((?:[\w-]+/)*[\w-]+\.(?:py|md|launch|srv|msg|action|rst))\b"
)
DOCUMENT = re.compile(r"(?<![\w./-])(?:[\w-]+/)*[\w-]+\.(?:md|rst)\b|\bdocs/adr/[0-9]{4}")
DECISION = re.compile(r"\bADR (\d+)")


def text(path: Path) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


def anchors(page: Path) -> set[str]:
    """Return the names that GitHub gives to the page's headings."""
    headings = re.findall(r"^#+ (.+)$", text(page), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def is_there(name: str, beside: Path) -> bool:
    """Whether a file is named: from the root, from beside the text, or by the end of its path."""
    if (ROOT / beside.parent / name).exists():
        return True
    parts = Path(name).parts
    return any(path.parts[-len(parts) :] == parts for path in FILES) or any(
        str(path).startswith(f"{name}-") for path in FILES
    )


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_every_link_leads_to_a_file_and_a_heading(page: Path) -> None:
    broken = []
    for link in LINK.findall(text(page)):
        if "://" in link:
            continue
        name, _, anchor = link.partition("#")
        target = (ROOT / page.parent / name) if name else ROOT / page
        if not target.exists() or (
            anchor and anchor not in anchors(target.resolve().relative_to(ROOT.resolve()))
        ):
            broken.append(link)
    assert broken == []


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_every_source_file_that_a_page_names_is_there(page: Path) -> None:
    without_blocks = re.sub(r"^ {4}.*$", "", text(page), flags=re.MULTILINE)
    named = {
        name
        for code in re.findall(r"`([^`\n]+)`", without_blocks)
        for name in NAMED_FILE.findall(code)
    }
    assert {name for name in named if not is_there(name, page)} == set()


def test_every_document_that_a_text_names_is_there() -> None:
    missing = {
        (str(path), name)
        for path in TEXTS
        if path.parts[0] != "test"
        for name in DOCUMENT.findall(text(path))
        if not is_there(name, path)
    }
    assert missing == set()


def test_every_decision_that_a_text_cites_is_there() -> None:
    decisions = {int(path.name[:4]) for path in PAGES if path.parent == Path("docs/adr")}
    assert len(decisions) > 10
    cited = {int(number) for path in TEXTS for number in DECISION.findall(text(path))}
    assert cited - decisions == set()


def test_the_readme_is_short_and_every_page_is_in_the_index() -> None:
    assert len(text(Path("README.md")).splitlines()) <= 150
    index = set(LINK.findall(text(Path("docs/README.md"))))
    pages = {path.name for path in PAGES if path.parent == Path("docs")} - {"README.md"}
    assert pages - index == set()
