"""The site of the documents is made without a warning: no link is broken, the API is there."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MKDOCS = ROOT / ".venv-docs" / "bin" / "mkdocs"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, made as `./roomba docs` makes it, elsewhere."""
    folder = tmp_path_factory.mktemp("site")
    done = make(ROOT / "mkdocs.yml", folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def make(configuration: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    places = ["--config-file", str(configuration), "--site-dir", str(folder)]
    command = [str(MKDOCS), "build", "--strict", *places]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NO_MKDOCS_2_WARNING": "true"}
    return subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=500
    )


def test_every_document_is_a_page(site: Path) -> None:
    for path in (ROOT / "docs").rglob("*.md"):
        name = path.relative_to(ROOT / "docs").with_suffix(".html").as_posix()
        made = site / name.replace("README.html", "index.html")
        assert made.is_file()
    assert (site / "start.html").is_file()


def test_the_api_is_told_by_docstrings(site: Path) -> None:
    text = (site / "api" / "roomba.planning.coverage.html").read_text("utf-8")
    assert 'id="roomba.planning.coverage.planner.CoveragePlanner.plan"' in text
    assert ":class:" not in text


def test_formulas_are_drawn_without_a_script(site: Path) -> None:
    for page in ("matching", "belief", "things", "coverage", "docking", "loop_closing"):
        text = (site / "algorithms" / f"{page}.html").read_text("utf-8")
        assert text.count('<math xmlns="http://www.w3.org/1998/Math/MathML"') >= 3
        assert "$" not in text


def test_nothing_is_fetched_from_elsewhere(site: Path) -> None:
    page = (site / "index.html").read_text("utf-8")
    assert 'src="http' not in page
    assert 'rel="stylesheet" href="http' not in page


def test_a_broken_link_ends_it(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "index.md").write_text("# A\n\n[gone](gone.md)\n", "utf-8")
    text = "site_name: x\nvalidation: {links: {not_found: warn}}\n"
    (tmp_path / "mkdocs.yml").write_text(text, "utf-8")
    done = make(tmp_path / "mkdocs.yml", tmp_path / "site")
    assert done.returncode == 1
    assert "gone.md" in done.stderr
