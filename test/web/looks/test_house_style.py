"""Colours and letters of the page: orange for what wants attention, two sizes and a bold."""

from __future__ import annotations

from typing import Any

import pytest
from web.conftest import EACH_SIZE, SIZES, Opened, in_each_scheme

PALETTE = "async () => (await import('/map/palette.js')).palette()"
LETTERS = """async () => {
    for (const part of document.querySelectorAll("details:not([hidden])")) part.open = true;
    for (let frame = 0; frame < 3; frame++) await new Promise(requestAnimationFrame);
    const found = new Set();
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
        const part = walker.currentNode.parentElement;
        if (!walker.currentNode.data.trim() || !part.getClientRects().length) continue;
        const { fontSize, fontWeight } = getComputedStyle(part), svg = part.closest("svg");
        const zoom = svg ? svg.getBoundingClientRect().width / svg.viewBox.baseVal.width : 1;
        found.add(`${Math.round(zoom * parseFloat(fontSize))} px, ${fontWeight}`);
    }
    return [...found].sort();
}"""
"""Sizes and weights of all that is written, with all parts unfolded."""
WRITTEN = """async () => {
    const { get, set } = await import("/store.js"), fonts = new Set();
    const any = CanvasRenderingContext2D.prototype, fill = any.fillText;
    any.fillText = function (...text) { fonts.add(this.font); fill.apply(this, text); };
    set("chosen", get("home").rooms.slice(0, 2).map((room) => room.name));
    await new Promise((done) => setTimeout(done, 1000));
    any.fillText = fill;
    return [...fonts].map((font) => font.replace(/ system-ui.*/, "")).sort();
}"""
"""Of all that is written on the map."""


def luminance(colour: str | list[int]) -> float:
    """Return how bright a colour is, by WCAG 2."""
    parts = (
        [int(colour[at : at + 2], 16) for at in (1, 3, 5)] if isinstance(colour, str) else colour
    )
    shares = [part / 255.0 for part in parts]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return sum(weight * s for weight, s in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str | list[int], other: str | list[int]) -> float:
    """Return the contrast of two colours, 1 to 21, by WCAG 2."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("size", [SIZES["desktop"]])
def test_what_the_lidar_sees_stands_out_and_wants_no_attention(opened: Opened) -> None:
    for scheme in in_each_scheme(opened.page):
        colours: dict[str, Any] = opened.page.evaluate(PALETTE)
        assert colours["scan"] not in {colours["warn"], colours["truth"]}
        floors = [tint for floor in colours["floors"].values() for tint in floor]
        for floor in (*floors, colours["cells"]["free"]):
            assert contrast(colours["scan"], floor) >= 4.5, (scheme, floor)


@EACH_SIZE
def test_there_are_two_sizes_and_a_bold(opened: Opened) -> None:
    letters = {f"{size} px, {weight}" for size in (14, 16) for weight in (400, 600)}
    for part in opened.parts():
        opened.show(part)
        found = set(opened.page.evaluate(LETTERS))
        assert found <= letters
        assert len(found) >= 3
    opened.show_map()
    written = set(opened.page.evaluate(WRITTEN))
    assert written <= {"14px", "16px", "600 14px", "600 16px"}
    assert len(written) >= 2
