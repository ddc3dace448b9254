"""One run of a campaign, carried out in a process that may be on another machine."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from roomba.commands.campaign.running.runs import CampaignRun, require_same
from roomba.commands.trials.figures import Figures
from roomba.errors import RoombaError

_ONE_AT_A_TIME: Final = threading.Lock()
"""Held by the run of this process: a worker's threads would slow each other's runs down."""
_OF_THE_MACHINE: Final = (MemoryError, OSError)
"""Errors of a run that are due to the machine: not enough memory or disk."""


@dataclass(frozen=True, slots=True)
class RunEnd:
    """What came of a run: its figures, or why there are none, and where and when it was made.

    ``began`` is s since 1970.
    """

    figures: Figures | None
    failure: str
    where: str
    began: float


Work = Callable[[CampaignRun], RunEnd | str]
"""What a worker does with each run: makes it, or returns why it has no result on this machine."""


def carried_out(run: CampaignRun) -> RunEnd | str:
    """Make a run; an error that it would have on any machine is its result.

    Without memory or disk the run has no result, and may be made again elsewhere. Raises
    OtherMachineError where this machine would not make the same run.
    """
    with _ONE_AT_A_TIME:
        require_same(run)
        try:
            return _end_of(run)
        except _OF_THE_MACHINE as error:
            return f"its machine failed it: {error!r}"


def _end_of(run: CampaignRun) -> RunEnd:
    # Imported here, so that the machine that only waits does not load it all.
    from roomba.commands.trials.runs import run_trial
    from roomba.commands.trials.warm import warm_up

    warm_up()
    began = time.time()
    figures, failure = None, ""
    try:
        figures = run_trial(run.trial).figures
    except RoombaError as error:
        failure = str(error)
    except _OF_THE_MACHINE:
        raise
    except (Exception, SystemExit) as error:  # the other runs go on
        failure = f"a fault of the program: {error!r}"
    return RunEnd(figures, failure, f"{socket.gethostname()}:{os.getpid()}", began)
