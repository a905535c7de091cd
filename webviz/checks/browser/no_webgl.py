"""Pages that do not start."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

PATIENCE_S = 20.0
"""A slow page takes some seconds for its scripts."""


class PageNotStarted(Check):
    """Page that does not start.

    A browser has been connected for 20 seconds, and its page has not started.

    Why:
        webviz draws with WebGL 2. A browser without it connects and shows nothing; so does one
        whose extensions or policies block the scripts of the page.

    Repair:
        Switch on hardware acceleration in the settings of the browser, or use another browser. This
        page of the browser says whether it has WebGL 2:

            chrome://gpu
    """

    id = "WEB001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such browser."""
        for each in observation.browsers:
            if each.waited_s >= PATIENCE_S:
                yield self.found(
                    f"The page of {each.name} has not started after {each.waited_s:.0f} s: "
                    "it has no WebGL, or its scripts are blocked.",
                    "Switch on hardware acceleration in that browser, or use another one.",
                    subject=each.name,
                    severity=Severity.ERROR,
                    evidence={"waited_s": round(each.waited_s)},
                )
