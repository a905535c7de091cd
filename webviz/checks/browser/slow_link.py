"""Links that are too slow."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class LinkTooSlow(Check):
    """Slow link.

    The link to a browser takes less than what is drawn, so clouds or images are reduced for it.

    Why:
        Radio links and VPNs are often slower than a lidar. webviz sends each browser what its link
        takes: fewer points and smaller images, instead of old ones.

    Repair:
        Show fewer displays, close panes of images, or limit the points of clouds (`max_points`).
        This shows which display takes how much of each link: Doctor, "Stamp to screen".
    """

    id = "WEB004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such browser."""
        for each in observation.browsers:
            if each.rate is not None and each.reduced:
                yield self.found(
                    f"The link to {each.name} is slow: {each.reduced}.",
                    "Show fewer clouds and images, or use a faster link.",
                    subject=each.name,
                    evidence={"bytes_per_s": round(each.rate), "reduced": each.reduced},
                )
