"""The request of a clean and its outcome by the names of before, for ``mission/commands.py``."""

from roomba.clean_request import CleanRequest
from roomba.mission.cleaning.result import CleanOutcome

__all__ = ["CleanOutcome", "CleanRequest"]
