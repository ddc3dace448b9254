"""The nodes' own diagnostics (REP 107)."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from roomba_ros.convert.common import header


def refused_message(
    now: float, node: str, counts: Mapping[str, int], newest: str, *, is_recent: bool
) -> DiagnosticArray:
    """Return how many messages a node refused, ``counts`` by topic, and why the ``newest`` one.

    The status is a warning while that ``is_recent``; ``now`` in s.
    """
    total = sum(counts.values())
    said = f"{total} messages were refused; the last: {newest}" if total else "nothing was refused"
    status = DiagnosticStatus(
        level=DiagnosticStatus.WARN if is_recent else DiagnosticStatus.OK,
        name=f"{node}: messages",
        message=said,
        hardware_id=node,
        values=[KeyValue(topic, str(count)) for topic, count in sorted(counts.items())],
    )
    return DiagnosticArray(header(now, ""), [status])


def processes_message(now: float, trouble: Mapping[str, str]) -> DiagnosticArray:
    """Return how the robot's processes are: by name what is wrong, empty when all is well."""
    return DiagnosticArray(
        header(now, ""),
        [
            DiagnosticStatus(
                level=DiagnosticStatus.ERROR if said else DiagnosticStatus.OK,
                name=f"{name}: process",
                message=said or "it runs",
                hardware_id=name,
            )
            for name, said in sorted(trouble.items())
        ],
    )


def line_message(now: float, trouble: str, robot: str) -> DiagnosticArray:
    """Return how the line of a robot that people own is; ``trouble`` is empty while it is well."""
    status = DiagnosticStatus(
        level=DiagnosticStatus.ERROR if trouble else DiagnosticStatus.OK,
        name=f"{robot}: line",
        message=trouble or "the robot answers",
        hardware_id=robot,
    )
    return DiagnosticArray(header(now, ""), [status])
