"""The result on the terminal, and as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from rich import box
from rich.markup import escape
from rich.table import Table

from roomba_bench.record import Better, PeerFigure, Record

_SIGNS = {True: "yes", False: "no", None: ""}


def number(value: float | None) -> str:
    """Return a figure with three digits that count, four from 100 on, thousands parted."""
    if value is None:
        return "–"
    if abs(value) >= 1000.0:
        digits = len(f"{abs(value):.0f}") - 4
        return f"{round(value, -digits):,.0f}"
    return f"{value:.4g}" if abs(value) >= 100.0 else f"{value:.3g}"


def aim(record: Record) -> str:
    """Return the aim with its direction."""
    if record.aim is None:
        return ""
    return f"{'≥' if record.better is Better.HIGHER else '≤'} {number(record.aim)}"


def ratio(record: Record, peer: PeerFigure) -> str:
    """Return how many times better ours is."""
    times = record.ratio(peer)
    return "" if times is None else f"{number(times)}x"


def rich_table(records: Sequence[Record]) -> Table:
    """Return the table for the terminal: a row of ours, and below it a row for each peer."""
    table = Table(box=box.SIMPLE_HEAD, title="ours and peers; a ratio above 1: ours is better")
    for name in ("topic", "case", "figure"):
        table.add_column(name, overflow="fold")
    for name in ("value", "unit", "aim", "reached", "ratio"):
        table.add_column(name, justify="right" if name in ("value", "aim", "ratio") else "left")
    for topic, rows in groupby(records, lambda record: record.topic):
        for record in rows:
            reached = _SIGNS[record.is_reached]
            colour = {"yes": "green", "no": "red"}.get(reached, "none")
            table.add_row(
                topic,
                escape(record.case),
                escape(record.figure + (f": {record.error}" if record.value is None else "")),
                f"[bold]{number(record.value)}[/]",
                record.unit,
                aim(record),
                f"[{colour}]{reached}[/]",
            )
            for peer in record.peers:
                name = f"  {peer.name} {peer.version}".rstrip()
                if peer.value is None:
                    name += f": {peer.error}"
                cells = (number(peer.value), record.unit, "", "", ratio(record, peer))
                table.add_row("", "", f"[dim]{escape(name)}[/]", *cells)
        table.add_section()
    return table


def markdown(records: Sequence[Record], preface: Sequence[str]) -> str:
    """Return the result as Markdown: a few lines, and a table per topic."""
    lines = [*preface, ""]
    for topic, rows in groupby(records, lambda record: record.topic):
        lines += [f"### {topic}", "", "| case | figure | ours | aim | reached | peers |"]
        lines += ["|---|---|---|---|---|---|"]
        for record in rows:
            ours = f"{number(record.value)} {record.unit}" if record.value is not None else "–"
            if record.error and record.value is None:
                ours += f" ({record.error})"
            peers = "; ".join(_peer(record, peer) for peer in record.peers)
            reached = _SIGNS[record.is_reached]
            cells = (record.case, record.figure, ours, aim(record), reached, peers)
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        lines.append("")
    return "\n".join(lines)


def _peer(record: Record, peer: PeerFigure) -> str:
    name = f"{peer.name} {peer.version}".rstrip()
    if peer.value is None:
        return f"{name}: not measured ({peer.error})"
    times = ratio(record, peer)
    return f"{name}: {number(peer.value)}" + (f" (**{times}**)" if times else "")
