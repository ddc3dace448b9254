"""Hooks by which mkdocs makes the site of the repository's documents; ``mkdocs.yml`` names them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

from lint import site_pages

ROOT: Final = Path(__file__).parents[1]
_ADR: Final = ROOT / "docs" / "adr"
_FORMULA: Final = re.compile(r"^\$\$\n(.+?)\n\$\$$|\$`([^`]+)`\$", re.MULTILINE | re.DOTALL)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Name headings as GitHub does, and put decisions and API into the navigation."""
    config.mdx_configs.setdefault("toc", {})["slugify"] = site_pages.anchor_of
    names = [path.name for path in _ADR.glob("*.md")]
    api = {name: f"{site_pages.API}/{name}.md" for name in _api(config)}
    config.nav = site_pages.whole_navigation(config.nav or [], names, api)
    return config


def _api(config: MkDocsConfig) -> dict[str, str]:
    return site_pages.api_pages(ROOT / "src", config.extra["api"])


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that do not lie in the folder of the documents."""

    def add(page: str, text: str) -> None:
        files.append(File.generated(config, page, content=text))

    for path, page in site_pages.OUTSIDE.items():
        add(page, (ROOT / path).read_text("utf-8"))
    titles = {path.name: site_pages.title_of(path.read_text("utf-8")) for path in _ADR.glob("*.md")}
    add(site_pages.DECISIONS, site_pages.decisions_page(titles))
    for name, text in _api(config).items():
        add(f"{site_pages.API}/{name}.md", text)
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Point links to pages of the site, and turn formulas into MathML, which needs no script."""
    place = page.file.src_uri
    if place.startswith(f"{site_pages.API}/") or place == site_pages.DECISIONS:
        return markdown
    return _FORMULA.sub(_formula, site_pages.for_site(markdown, place))


def _formula(found: re.Match[str]) -> str:
    block, inline = found.groups()
    return str(convert(block or inline, display="block" if block else "inline"))
