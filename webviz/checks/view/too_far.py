"""Displays that are too far away to be drawn."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.view.picture import MAX_DEPTH_M, places


class TooFar(Check):
    """Outside the clip range.

    What a display draws is more than 100 km away from the camera.

    Why:
        Nothing farther than that is drawn. Coordinates in another unit, or of a globe in a frame
        whose origin is a robot, are such distances.

    Repair:
        Correct the unit of the data, or publish the transform between the frame of the data and a
        local frame.
    """

    id = "VIEW005"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        for display in observation.displays:
            if display.box is None:
                continue
            positions = list(places(observation, display.box))
            if positions and all(
                each.is_inside and each.depth_m > MAX_DEPTH_M for each in positions
            ):
                depth_m = min(each.depth_m for each in positions)
                yield self.found(
                    f"{display.display.name} is {depth_m / 1000.0:.0f} km away, which is too far.",
                    "Check the unit of its coordinates and its frame.",
                    subject=display.display.name,
                    evidence={"depth_m": depth_m},
                )
