"""``./roomba bench``: measure this project and its peers in the same run, and print the result."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import traceback
from pathlib import Path

from rich.console import Console

from roomba.commands.first_use import require_compiled
from roomba.commands.options import HelpfulParser, UsageError, check_written, file_of
from roomba.commands.process_end import quiet_end
from roomba.commands.program_name import spelled
from roomba_bench.bench import Bench
from roomba_bench.machine import Machine
from roomba_bench.places import HERE
from roomba_bench.plot import write_plot
from roomba_bench.record import Better, Record, write_json
from roomba_bench.rounds import QUICK, THOROUGH, Pace
from roomba_bench.table import markdown, rich_table
from roomba_bench.topics import TOPICS, left_out, measure


def main(arguments: list[str] | None = None) -> int:
    """Return 1 if a figure of ours could not be measured, else 0, even if an aim was missed."""
    parser = _parser()
    options = parser.parse_args(arguments)
    unknown = [topic for topic in options.topics if topic not in TOPICS]
    if unknown:
        parser.error(f"expected topics out of {', '.join(TOPICS)}; came {', '.join(unknown)}")
    if options.maps is not None and not options.maps.is_dir():
        parser.error(f"--maps: expected a folder of map_server maps; came {options.maps}")
    if options.logs is not None and not options.logs.is_dir():
        parser.error(f"--logs: expected a folder of recorded drives; came {options.logs}")
    if options.peers is not None and not options.peers.is_file():
        parser.error(f"--peers: expected a program, the Python of the peers; came {options.peers}")
    topics = list(dict.fromkeys(options.topics)) or _usual_topics()
    picture = options.plot or options.out / f"{'-'.join(topics)}.png"
    try:
        _check_written(options, picture)
    except (UsageError, OSError) as error:
        parser.error(str(error))
    require_compiled(is_quiet=False)
    pace = QUICK if options.quick else THOROUGH
    machine = Machine.this()
    preface = (f"{machine}.", f"Figures are the {pace}; ratios are within this run.")
    records: list[Record] = []
    for topic in topics:
        with tempfile.TemporaryDirectory() as folder:
            records += _measure(topic, _bench(options, pace, Path(folder)))
    _tell(records, preface, to_errors=options.json == "-")
    write_plot(picture, records, " ".join(preface))
    if options.json:
        write_json(file_of(options.json), records)
    if options.markdown:
        options.markdown.write_text(markdown(records, preface) + "\n", encoding="utf-8")
    return 1 if any(record.value is None and not record.lacks_peer for record in records) else 0


def _check_written(options: argparse.Namespace, picture: Path) -> None:
    """Refuse now what could not be written minutes later; raises UsageError and OSError."""
    picture.parent.mkdir(parents=True, exist_ok=True)
    written = [
        ("--plot", picture),
        ("--json", file_of(options.json)),
        ("--markdown", options.markdown),
    ]
    check_written(written, [])


def _usual_topics() -> list[str]:
    """Return all topics that can be measured here; print the others with the reason."""
    for topic in TOPICS:
        if left_out(topic):
            print(f"bench: {topic} is left out: {left_out(topic)}", file=sys.stderr)
    return [topic for topic in TOPICS if not left_out(topic)]


def _bench(options: argparse.Namespace, pace: Pace, folder: Path) -> Bench:
    peers = None if options.peers is None else options.peers.absolute()
    return Bench(pace, folder, options.maps, options.logs, options.out, peers)


def _parser() -> argparse.ArgumentParser:
    about = "\n".join(f"  {name:14}{what}" for name, what in TOPICS.items())
    parser = HelpfulParser(
        prog=spelled("bench"),
        description="Measure claims about speed, each beside its peers in the same run.",
        epilog=f"topics:\n{about}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "topics", nargs="*", metavar="TOPIC", help="default: all that there can be here"
    )
    parser.add_argument(
        "--json",
        nargs="?",
        const="-",
        metavar="FILE|-",
        help="write the records as a list; -, or nothing: to standard output",
    )
    parser.add_argument(
        "--plot", type=Path, metavar="FILE.png", help="default: in the folder of --out"
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=HERE.results,
        metavar="FOLDER",
        help="for the plot and the topics' pictures; default: benchmarks/results of a checkout, "
        "else bench.results",
    )
    parser.add_argument(
        "--peers",
        type=Path,
        default=HERE.peers,
        metavar="PYTHON",
        help="of an environment that has the peers; default: that of .venv-bench of a checkout",
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
    """Return a topic's rows; if the topic fails, one row with the error: the other topics go on."""
    try:
        return measure(topic, bench)
    except Exception as error:
        traceback.print_exc()
        reason = f"{type(error).__name__}: {error}".replace(f"{HERE.root}/", "")
        return [Record(topic, "all", "everything", None, "", Better.HIGHER, error=reason)]


def _tell(records: list[Record], preface: tuple[str, ...], *, to_errors: bool) -> None:
    # A pipe has no width; in narrow columns every name would be broken.
    width = None if (sys.stderr if to_errors else sys.stdout).isatty() else 180
    console = Console(width=width, stderr=to_errors)
    console.print(rich_table(records))
    for line in preface:
        console.print(line, highlight=False)
    console.print(f"load {os.getloadavg()[0]:.2f} at the end", highlight=False)


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
