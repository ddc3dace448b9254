"""The command line, parsed and checked before anything heavy is loaded."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.campaign.running.machines import Machines
from roomba.commands.options import Parser, UsageError, check_written, file_of, whole
from roomba.commands.program_name import spelled

PROGRAM: Final = spelled("campaign")
_MOST_PROCESSES: Final = 1024


@dataclass(frozen=True, slots=True)
class CampaignOptions:
    """A campaign's file, where its runs are made, and what is told; ``out`` is for its results."""

    file: Path
    machines: Machines
    out: Path
    json: str | None
    plot: Path | None
    quiet: bool
    keep: bool


def options_of(arguments: list[str] | None) -> CampaignOptions:
    """Return what a command line asks for; raises UsageError, and SystemExit for ``--help``."""
    given = _parser().parse_args(arguments)
    if not given.file.is_file():
        raise UsageError(f"expected the file of a campaign, got {given.file}")
    if given.cluster is not None and given.processes is not None:
        raise UsageError("expected --cluster or --processes, got both; leave one out")
    out = given.out or given.file.with_suffix(".results")
    if out.exists() and not out.is_dir():
        raise UsageError(f"--out: expected a folder, got the file {out}")
    check_written([("--json", file_of(given.json)), ("--plot", given.plot)], [("", given.file)])
    machines = Machines(given.cluster, given.processes)
    return CampaignOptions(
        given.file, machines, out, given.json, given.plot, given.quiet, given.keep
    )


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        "Run homes, seeds and variants of the robot on all cores or on a cluster, and compare the "
        "variants. What has ended is stored: the same command goes on where it was stopped.",
        "Exit status: 0 all runs have figures, 1 some have none, 2 wrong usage.",
    )
    parser.add_argument(
        "file", type=Path, metavar="FILE.yaml", help="what it is of: see docs/campaigns.md"
    )
    where = parser.add_argument_group("where")
    where.add_argument(
        "--cluster",
        metavar="HOST:PORT|local:N",
        help="a scheduler of dask.distributed; local:N: start one with N workers",
    )
    where.add_argument(
        "--processes",
        type=whole(1, _MOST_PROCESSES),
        metavar="N",
        help="so many processes of this machine (default: one for each core)",
    )
    told = parser.add_told("all runs and comparisons", "a picture of the differences")
    told.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="where the results are (default: beside FILE.yaml, FILE.results)",
    )
    told.add_argument(
        "--no-history", dest="keep", action="store_false", help="do not keep the runs for `report`"
    )
    return parser
