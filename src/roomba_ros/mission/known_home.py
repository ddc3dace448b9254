"""A home as the mission knows it, of one map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.matching.surface_field import SurfaceField

GROWING: Final = "growing"
"""The digest of every map that is being made."""


@dataclass(frozen=True, slots=True, eq=False)
class KnownHome:
    """A planning context, the surface field of its map, and the map's digest.

    All stages of a map that is being made have the same ``digest``.
    """

    context: PlanningContext
    field: SurfaceField
    digest: str

    def is_edit_of(self, before: KnownHome) -> bool:
        """Whether station or zones differ from ``before``: such a change is obeyed at once."""
        now, then = self.context, before.context
        return (now.station, now.zones) != (then.station, then.zones)
