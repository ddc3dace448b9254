"""``./roomba bench``: measure ours and peers in the same run, and tell it."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import traceback
from pathlib import Path

from rich.console import Console

from benchmarks.bench import Bench
from benchmarks.contestants import REPOSITORY
from benchmarks.machine import Machine
from benchmarks.plot import write_plot
from benchmarks.record import Better, Record, write_json
from benchmarks.rounds import QUICK, THOROUGH
from benchmarks.table import markdown, rich_table
from benchmarks.topics import TOPICS, measure

RESULTS = REPOSITORY / "benchmarks" / "results"


def main(arguments: list[str] | None = None) -> int:
    """Return 1 if something of ours could not be measured; aims need not be reached."""
    parser = _parser()
    options = parser.parse_args(arguments)
    unknown = [topic for topic in options.topics if topic not in TOPICS]
    if unknown:
        parser.error(f"expected topics out of {', '.join(TOPICS)}; came {', '.join(unknown)}")
    if options.logs is not None and not options.logs.is_dir():
        parser.error(f"--logs: expected a folder of recorded drives; came {options.logs}")
    topics = list(dict.fromkeys(options.topics)) or list(TOPICS)
    pace = QUICK if options.quick else THOROUGH
    machine = Machine.this()
    preface = (f"{machine}.", f"Figures are the {pace}; ratios are within this run.")
    records: list[Record] = []
    for topic in topics:
        with tempfile.TemporaryDirectory() as folder:
            records += _measure(topic, Bench(pace, Path(folder), options.maps, options.logs))
    _tell(records, preface, to_errors=options.json == "-")
    write_plot(options.plot or RESULTS / f"{'-'.join(topics)}.png", records, " ".join(preface))
    if options.json:
        write_json(None if options.json == "-" else Path(options.json), records)
    if options.markdown:
        options.markdown.write_text(markdown(records, preface) + "\n", encoding="utf-8")
    return 1 if any(record.value is None for record in records) else 0


def _parser() -> argparse.ArgumentParser:
    about = "\n".join(f"  {name:10}{what}" for name, what in TOPICS.items())
    parser = argparse.ArgumentParser(
        prog="./roomba bench",
        description="Measure claims about speed, each beside its peers in the same run.",
        epilog=f"topics:\n{about}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("topics", nargs="*", metavar="TOPIC", help="all, if none is named")
    parser.add_argument(
        "--json",
        nargs="?",
        const="-",
        metavar="FILE|-",
        help="write the records as a list; -, or nothing: to standard output",
    )
    parser.add_argument(
        "--plot", type=Path, metavar="FILE.png", help="default: in benchmarks/results"
    )
    parser.add_argument("--markdown", type=Path, metavar="FILE", help="write tables for a README")
    parser.add_argument(
        "--quick", action="store_true", help="fewer and shorter rounds: rough figures"
    )
    parser.add_argument(
        "--maps",
        type=Path,
        metavar="FOLDER",
        help="measure lidar, localization, rooms, coverage, mapping on the map_server maps in it",
    )
    parser.add_argument(
        "--logs",
        type=Path,
        metavar="FOLDER",
        help="measure slam on the recorded drives in it, with the truth of their .relations",
    )
    return parser


def _measure(topic: str, bench: Bench) -> list[Record]:
    """Return a topic's rows; one that breaks down is a row that says so, the others still come."""
    try:
        return measure(topic, bench)
    except Exception as error:
        traceback.print_exc()
        reason = f"{type(error).__name__}: {error}".replace(f"{REPOSITORY}/", "")
        return [Record(topic, "all", "everything", None, "", Better.HIGHER, error=reason)]


def _tell(records: list[Record], preface: tuple[str, ...], *, to_errors: bool) -> None:
    # A pipe has no width of its own; narrow columns would tear every name apart.
    width = None if (sys.stderr if to_errors else sys.stdout).isatty() else 180
    console = Console(width=width, stderr=to_errors)
    console.print(rich_table(records))
    for line in preface:
        console.print(line, highlight=False)
    console.print(f"load {os.getloadavg()[0]:.2f} at the end", highlight=False)


if __name__ == "__main__":
    sys.exit(main())
