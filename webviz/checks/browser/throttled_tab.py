"""Tabs that do not run."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

FROZEN_S = 15.0
"""Pages report every five seconds."""
LATE_S = 4.0


class ThrottledTab(Check):
    """Throttled tab.

    The page of a browser is in the background, frozen, or its timers are seconds late.

    Why:
        Browsers draw nothing in hidden tabs, freeze them to save energy, and a processor
        that is too busy delays everything. What such a page shows is old.

    Repair:
        Bring the tab to the front, exclude the page from the energy saver of the browser, or close
        programs on that machine.
    """

    id = "WEB003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such browser."""
        for each in observation.browsers:
            if each.waited_s or not each.renderer:
                continue
            evidence = {"silent_s": round(each.silent_s), "late_s": round(each.late_s, 1)}
            if each.is_hidden:
                yield self.found(
                    f"The tab of {each.name} is in the background, so it draws nothing.",
                    "Bring the tab to the front.",
                    subject=each.name,
                    severity=Severity.NOTE,
                    evidence=evidence,
                )
            elif each.silent_s >= FROZEN_S:
                yield self.found(
                    f"The page of {each.name} has been silent for {each.silent_s:.0f} s: its "
                    "browser has frozen it, or its machine sleeps.",
                    "Bring the tab to the front, and exclude it from the energy saver.",
                    subject=each.name,
                    evidence=evidence,
                )
            elif each.late_s >= LATE_S:
                yield self.found(
                    f"Timers in the page of {each.name} are {each.late_s:.0f} s late: its browser "
                    "throttles it, or its processor is too busy.",
                    "Bring the tab to the front, or close programs on that machine.",
                    subject=each.name,
                    evidence=evidence,
                )
