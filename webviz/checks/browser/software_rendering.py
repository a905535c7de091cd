"""Browsers without a graphics card."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class SoftwareRendering(Check):
    """Software rendering.

    A browser draws with the processor instead of a graphics card. It is a note: everything is
    drawn, only more slowly.

    Why:
        Large clouds and meshes become slow, and take the processor from everything else on that
        machine. Virtual machines, remote desktops and browsers without drivers draw like that.

    Repair:
        Switch on hardware acceleration in the settings of the browser, install the driver of the
        graphics card, or open the page on another machine.
    """

    id = "WEB002"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such browser."""
        for each in observation.browsers:
            if each.is_software and not each.is_hidden:
                takes = f", {1000 * each.frame_s:.0f} ms for a frame" if each.frame_s else ""
                yield self.found(
                    f"The processor draws for {each.name}, not a graphics card{takes}.",
                    "Switch on hardware acceleration in that browser, or use another machine.",
                    subject=each.name,
                    severity=Severity.NOTE,
                    evidence={"renderer": each.renderer, "frame_s": each.frame_s},
                )
