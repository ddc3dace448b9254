"""Links of the documents as they are on their site; every document is in its navigation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from lint import site_pages

ROOT = Path(__file__).parents[3]
SITE: dict[str, Any] = yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))


@pytest.mark.parametrize(
    ("text", "place", "expected"),
    [
        ("[all](commands.md#the-rest)", "page.md", "[all](commands.md#the-rest)"),
        ("[help](../CONTRIBUTING.md#tests)", "gym.md", "[help](contributing.md#tests)"),
        ("[it](../../benchmarks/README.md)", "adr/0001-a.md", "[it](../benchmarks.md)"),
        ("[all](../benchmarks/measured/slam.md#x)", "gym.md", "[all](measured/slam.md#x)"),
        ("[how](../../docs/gym.md)", "measured/slam.md", "[how](../gym.md)"),
        ("![a map](docs/pictures/map.png)", "start.md", "![a map](pictures/map.png)"),
        ("[why](docs/adr/0001-a.md)", "contributing.md", "[why](adr/0001-a.md)"),
        ("[all](docs/adr/)", "start.md", "[all](adr/README.md)"),
        ("[numbers](../src/roomba/data/x.yaml)", "page.md", "numbers"),
        ("[here](#tests) and [there](https://a.b/c)", "page.md", None),
        ("    [code](../README.md)\n", "page.md", None),
        ("```text\n[code](../README.md)\n```", "page.md", None),
    ],
)
def test_links_lead_where_the_page_is_on_the_site(
    text: str, place: str, expected: str | None
) -> None:
    assert site_pages.for_site(text, place) == (text if expected is None else expected)


def test_a_picture_may_be_a_link() -> None:
    text = "    code\n\n[![a map](pictures/map.png)](../README.md)"
    assert (
        site_pages.for_site(text, "page.md") == "    code\n\n[![a map](pictures/map.png)](start.md)"
    )


def test_headings_are_named_as_on_github() -> None:
    assert site_pages.anchor_of("Make a map: `./roomba map`") == "make-a-map-roomba-map"


def test_every_document_is_in_the_navigation_once() -> None:
    documents = {path.relative_to(ROOT / "docs").as_posix() for path in ROOT.glob("docs/**/*.md")}
    decisions = {name for name in documents if name.startswith("adr/")}
    navigation = site_pages.whole_navigation(SITE["nav"], [name[4:] for name in decisions], {})
    named = site_pages.pages_of(navigation)
    outside = {*site_pages.OUTSIDE.values(), site_pages.DECISIONS}
    assert sorted(named) == sorted(documents | outside)


def test_the_api_names_folders_with_modules() -> None:
    pages = site_pages.api_pages(ROOT / "src", SITE["extra"]["api"])
    assert len(pages) == len(SITE["extra"]["api"])
    assert "::: roomba.planning.coverage.planner" in pages["roomba.planning.coverage"]


def test_decisions_are_listed_with_their_titles() -> None:
    page = site_pages.decisions_page({"0002-b.md": "Second", "0001-a.md": "First"})
    assert page.index("0001. [First](0001-a.md)") < page.index("0002. [Second](0002-b.md)")
    with pytest.raises(ValueError, match="found none"):
        site_pages.title_of("no heading")
