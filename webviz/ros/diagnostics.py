"""Findings of the doctor as diagnostic messages."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from diagnostic_msgs.srv import SelfTest
from rclpy.node import Node

from webviz.api.finding import Fact, Finding, Severity
from webviz.data.words import joined

__all__ = ["DiagnosticsPublisher", "SelfTest", "statuses_of"]

TOPIC = "/diagnostics"
EVERY_S = 1.0
LEVELS = {
    Severity.NOTE: DiagnosticStatus.OK,
    Severity.WARNING: DiagnosticStatus.WARN,
    Severity.ERROR: DiagnosticStatus.ERROR,
}


class DiagnosticsPublisher:
    """Publishes findings on /diagnostics, once a second.

    Args:
        node: that publishes.
        find: returns the findings of the last round.
    """

    def __init__(self, node: Node, find: Callable[[], Sequence[Finding]]) -> None:
        self._node = node
        self._find = find
        self._publisher = node.create_publisher(DiagnosticArray, TOPIC, 10)
        self._next_s = 0.0

    def turn(self) -> None:
        """Publish if it is time; to be called often."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + EVERY_S
            array = DiagnosticArray(status=statuses_of(self._find()))
            array.header.stamp = self._node.get_clock().now().to_msg()
            self._publisher.publish(array)

    def close(self) -> None:
        """End the publisher."""
        self._node.destroy_publisher(self._publisher)


def statuses_of(findings: Sequence[Finding]) -> list[DiagnosticStatus]:
    """Return a status for each finding, and one for the doctor as a whole at the beginning."""
    severe = [finding for finding in findings if finding.severity > Severity.NOTE]
    whole = DiagnosticStatus(
        level=LEVELS[max((finding.severity for finding in severe), default=Severity.NOTE)],
        name="webviz: doctor",
        message=severe[0].cause if severe else "No problems found.",
    )
    return [whole, *map(_status, findings)]


def _status(finding: Finding) -> DiagnosticStatus:
    command = {"command": finding.command} if finding.command else {}
    return DiagnosticStatus(
        level=LEVELS[finding.severity],
        name=f"webviz: {finding.id}",
        message=joined(finding.cause, finding.remedy),
        hardware_id=finding.subject,
        values=[
            KeyValue(key=name, value=_text(fact))
            for name, fact in {**finding.evidence, **command}.items()
        ],
    )


def _text(fact: Fact) -> str:
    return ", ".join(fact) if isinstance(fact, tuple) else str(fact)
