"""Displays that are too small to be seen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.view.picture import places


class TooSmall(Check):
    """Smaller than a pixel.

    All that a display draws is smaller than a pixel in every browser that could show it.

    Why:
        A mesh in millimetres that is read as metres is a thousand times too large, and one in
        metres that is scaled by 0.001 is a point. A size of 0 does the same.

    Repair:
        Zoom in on the display (F while it is selected). If it is too small there as well, correct
        its size or scale.
    """

    id = "VIEW003"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        for display in observation.displays:
            if display.box is None:
                continue
            inside = [each for each in places(observation, display.box) if each.is_inside]
            if inside and all(each.pixels < 1.0 for each in inside):
                size_m = float(np.linalg.norm(display.box.high - display.box.low))
                yield self.found(
                    f"{display.display.name} is {size_m:.2g} m in size, less than a pixel.",
                    "Focus on it, or correct its size or scale.",
                    subject=display.display.name,
                    evidence={"size_m": size_m, "pixels": max(each.pixels for each in inside)},
                )
