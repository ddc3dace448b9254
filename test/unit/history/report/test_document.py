"""Reports are read as HTML, and their figures compared with the run."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from roomba.history.report.document import comparison_of, report_of
from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_rows import KeptRun
from roomba.vocabulary import EdgeReason

VOID = ("meta", "link", "br", "img", "input")


class Read(HTMLParser):
    """The cells of all tables by row, the addresses that are referred to, and what is left open."""

    def __init__(self, document: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.addresses: list[str] = []
        self.tags: list[str] = []
        self.open: list[str] = []
        self.title = ""
        self.feed(document)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)
        self.addresses += [value or "" for name, value in attributes if name in ("href", "src")]
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for name, value in attributes if name in ("href", "src")]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data
        if self.open and self.open[-1] == "title" and "svg" not in self.open:
            self.title += data


@pytest.fixture
def kept(figures: RunFigures) -> KeptRun:
    return KeptRun(12, figures, True)


def test_the_figures_are_those_of_the_run(kept: KeptRun, recording: RunRecording) -> None:
    read = Read(report_of(kept, recording))
    assert read.open == []
    assert read.title.startswith("Run 12: box, ")
    told = dict(row for row in read.rows if len(row) == 2)
    assert told["Clean"] == "11.00 m² of 12.00 m²"
    assert told["Share"] == "91.7 %"
    assert told["Time"] == "1 min 00 s"
    assert told["Rate"] == "11.00 m² a minute, 2.81 times the least time for that floor"
    assert ["Turning on the spot", "0 min 12 s", "20.0 %"] in read.rows
    assert not any("Charging" in row for row in read.rows)
    assert told["Way"] == "24.0 m"
    assert told["Turning"] == "6.5 rad"
    assert told["Dirt"] == "3.25 g"
    assert told["Energy"] == "–"
    assert told["Seed"] == "7"
    assert ["1", "hall", "1.00 m²", "a thing <stood> in the way"] in read.rows
    assert "Mapped" not in told
    assert ["1.5 m", "(4.0, 1.0)", EdgeReason.NO_ECHO.value] in read.rows


def test_of_an_exploration_it_tells_what_was_mapped_and_nothing_open_where_nothing_is(
    kept: KeptRun, recording: RunRecording
) -> None:
    explored = replace(kept.figures, kind="explore", mapped=34.5, open_edges=())
    document = report_of(replace(kept, figures=explored), recording)
    assert ["Mapped", "34.50 m²"] in Read(document).rows
    assert "stays open" not in document


def test_it_stands_alone(kept: KeptRun, recording: RunRecording) -> None:
    document = report_of(kept, recording)
    read = Read(document)
    assert read.addresses
    assert all(address.startswith("data:image/png;base64,") for address in read.addresses)
    assert "script" not in read.tags
    assert re.findall(r"url\(|@import|https?://(?!www\.w3\.org/2000/svg)", document) == []
    assert kept.figures.source.repeat in document


def test_the_floor_is_drawn_where_it_is(kept: KeptRun, recording: RunRecording) -> None:
    document = report_of(kept, recording)
    svg = ElementTree.fromstring(re.findall(r"<svg.*?</svg>", document)[0])
    space = "{http://www.w3.org/2000/svg}"
    assert [float(part) for part in svg.attrib["viewBox"].split()] == [-20, -320, 440, 340]
    way = svg.find(f"{space}polyline")
    assert way is not None
    assert way.attrib["points"].startswith("50,-150 ")
    assert way.attrib["points"].endswith(" 350,-150")
    circle = svg.find(f"{space}circle")
    assert circle is not None
    assert (circle.attrib["cx"], circle.attrib["cy"]) == ("350", "-250")
    assert circle.attrib["r"] == "12"
    texts = {text.attrib["class"]: text.text for text in svg.iter(f"{space}text")}
    assert (texts["number"], texts["size"]) == ("1", "1.00 m²")
    title = svg.find(f"{space}title")
    assert title is not None
    assert title.text == "Floor of box: 91.7 % clean, 1 place missed"
    assert len(svg.findall(f"{space}image")) == 2


def test_weeks_and_the_dirt_of_the_home_are_told(
    kept: KeptRun,
    recording: RunRecording,
) -> None:
    later = replace(kept.figures, began=kept.figures.began + 7 * 86400.0, dirt=6.5)
    read = Read(report_of(kept, recording, [kept, KeptRun(13, later, False)]))
    weeks = [row for row in read.rows if re.fullmatch(r"\d{4}-W\d\d", row[0])]
    assert [row[1] for row in weeks] == ["1", "1"]
    assert [row[5] for row in weeks] == ["6.5 g", "3.2 g"]


def test_a_run_without_a_recording_is_told(kept: KeptRun) -> None:
    document = report_of(kept, None)
    assert Read(document).open == []
    assert "no longer kept" in document


def test_two_runs_are_compared(kept: KeptRun, recording: RunRecording) -> None:
    other = KeptRun(15, replace(kept.figures, covered=11.5, distance=20.0, missed=()), True)
    read = Read(comparison_of((kept, recording), (other, recording)))
    assert read.open == []
    assert ["Clean, m²", "11.00", "11.50", "+0.50"] in read.rows
    assert ["Way, m", "24.0", "20.0", "−4.0"] in read.rows
    assert ["Time, min", "1.0", "1.0", "+0.0"] in read.rows
    assert ["Energy, Wh", "–", "–", "–"] in read.rows
    assert ["Places missed", "1", "0", "−1"] in read.rows


def test_a_place_that_is_less_than_is_told_in_numbers_is_no_nothing(kept: KeptRun) -> None:
    (miss,) = kept.figures.missed
    figures = replace(kept.figures, missed=(replace(miss, area=0.004),))
    read = Read(report_of(replace(kept, figures=figures), None))
    assert ["1", "hall", "< 0.01 m²", "a thing <stood> in the way"] in read.rows


def test_what_a_run_was_asked_for_by_is_told_where_its_command_does_not(kept: KeptRun) -> None:
    wish = {"request": {"mode": "rooms", "rooms": ["<hall>"]}}
    for program, is_told in (("play", True), ("sim", False)):
        source = replace(kept.figures.source, program=program, configuration=wish)
        document = report_of(replace(kept, figures=replace(kept.figures, source=source)), None)
        assert ("POST /api/v1/clean\n{&quot;mode&quot;: &quot;rooms&quot;" in document) is is_told
        assert "<hall>" not in document
