"""Displays that are transparent."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import ChangeDisplay, Finding
from webviz.api.observation import Observation
from webviz.api.status import Remedy


class Invisible(Check):
    """Display is transparent.

    The alpha of a display is 0, so that nothing of it can be seen.

    Why:
        The display works and shows nothing, which is easy to overlook in an unfamiliar config.

    Repair:
        Set alpha to 1.
    """

    id = "VIEW001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        for display in observation.displays:
            if getattr(display.display, "alpha", None) == 0.0:
                yield self.found(
                    f"The alpha of {display.display.name} is 0, so it cannot be seen.",
                    "Set its alpha to 1.",
                    subject=display.display.name,
                    button=ChangeDisplay(display.id, Remedy("alpha", 1.0, "Set alpha to 1")),
                    explains=tuple(s for key in display.statuses for s in display.symptom(key)),
                )
