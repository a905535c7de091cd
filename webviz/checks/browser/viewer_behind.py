"""Viewers that cannot keep up."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

BUSY = 0.9
"""Share of a core that the frame loop runs, or waits for."""
OWN = 0.2
"""Share that a display takes; else other programs have the processor."""


class ViewerBehind(Check):
    """Viewer that cannot keep up.

    Reading and drawing messages takes all of a processor's core, so that the viewer shows old data.

    Why:
        All displays share one thread. One with large or many messages delays the others.

    Repair:
        Hide the display that takes most, lower its rate or the size of its messages, or lower the
        frame rate of the viewer. Doctor, "Stamp to screen" shows the share of each display.
    """

    id = "WEB006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such viewer."""
        if observation.load < BUSY or observation.is_recorded:
            return
        most = max(observation.displays, key=lambda each: each.core, default=None)
        if most is None or most.core < OWN:
            return
        cores = {
            each.display.name: round(each.core, 3) for each in observation.displays if each.core
        }
        name = most.display.name
        yield self.found(
            f"The viewer cannot keep up: it needs {100 * observation.load:.0f} % of a core; {name} "
            f"takes {100 * most.core:.0f} %.",
            f"Hide {name}, or send it fewer or smaller messages.",
            subject="viewer",
            evidence={"load": round(observation.load, 2), **cores},
        )
