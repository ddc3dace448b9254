"""How long an errand goes on while the robot does not know its place."""

from __future__ import annotations

from roomba.configuration.loops import WalkConfig
from roomba.perception.localization.estimate import Knowledge


class SearchPatience:
    """Tells when an errand is given up because the place is not found.

    A robot that becomes lost on its way has looked around in vain. One that stood lost when it was
    told to drive looks around first: its search begins anew with the errand.
    """

    def __init__(self, config: WalkConfig, knowledge: Knowledge) -> None:
        """Begin an errand with what is known of the place."""
        self._config = config
        self.begin(knowledge)

    def begin(self, knowledge: Knowledge) -> None:
        """Begin anew with what is known of the place."""
        self._begins_lost = knowledge is Knowledge.LOST

    def is_over(self, knowledge: Knowledge, searched: float) -> bool:
        """Return whether to give up, as the place is not known for ``searched`` s."""
        is_lost = knowledge is Knowledge.LOST
        self._begins_lost = self._begins_lost and is_lost
        if self._begins_lost:
            return searched > self._config.search_wait
        return is_lost or searched > self._config.astray_timeout
