"""Transforms of another clock."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class ClocksDiffer(Check):
    """Clocks of transforms differ.

    Transforms are stamped with a time that differs from that of webviz.

    Why:
        Data and transforms of different clocks do not meet: the data waits for transforms that come
        too late or came long ago.

    Repair:
        Synchronise the clocks of the machines (chrony, NTP), or follow the time of a bag that is
        replayed with `--clock`.
    """

    id = "TIME010"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        status = seen.statuses.get("Clocks")
        explains = seen.symptom("Clocks")
        if status and explains:
            cause, _, remedy = status.text.partition(": ")
            yield self.found(
                f"{cause.rstrip('.')}.",
                f"{remedy[:1].upper()}{remedy[1:]}" or "Use one clock for all nodes.",
                evidence={"status": status.text},
                command="chronyc tracking",
                explains=explains,
            )
