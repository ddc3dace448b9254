"""Steps of a look at the robot: each is taken even if another one fails, which is told."""

from __future__ import annotations

import traceback
from collections.abc import Callable

from roomba.errors import RoombaError


class NotDoneError(RoombaError):
    """A step cannot be done now; the text tells people why."""


class Steps:
    """Takes steps; what goes wrong is told once for each reason, for as long as it lasts."""

    def __init__(self, tell: Callable[[str], object]) -> None:
        """Begin before the first step."""
        self._tell = tell
        self._told: tuple[str, ...] = ()

    def take(self, *steps: Callable[[], None]) -> None:
        """Take steps, each of them also if another one fails.

        What went wrong already in the call before is not told again.
        """
        # Steps that fail for one reason tell it once.
        troubles = tuple(dict.fromkeys(filter(None, map(_trouble_of, steps))))
        for trouble in troubles:
            if trouble not in self._told:
                self._tell(trouble)
        self._told = troubles


def _trouble_of(step: Callable[[], None]) -> str:
    """Take a step; return what went wrong, empty if nothing did."""
    try:
        step()
    except NotDoneError as error:
        return str(error)
    except OSError as error:
        return f"what belongs to the household was not kept: {error}"
    except Exception as error:
        fault = "".join(traceback.format_exception(error))
        return f"a fault of the program, and the household goes on without this step: {fault}"
    return ""
