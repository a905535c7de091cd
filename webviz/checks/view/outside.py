"""Displays that are outside the view."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.view.picture import places


class OutsideView(Check):
    """Outside the view.

    What displays draw is outside the picture of every browser.

    Why:
        Everything works, but the camera looks elsewhere: at the origin while the robot is
        kilometres away, as in a map with UTM coordinates, or away from it after a config of another
        place was opened.

    Repair:
        Focus on the display (F while it is selected), reset the view (Z), or let it follow the
        robot (target frame).
    """

    id = "VIEW004"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such viewer."""
        boxes = [(each, each.box) for each in observation.displays if each.box is not None]
        outside = []
        for display, box in boxes:
            positions = list(places(observation, box))
            if positions and not any(each.is_inside for each in positions):
                outside.append(display.display.name)
        if not outside:
            return
        is_empty = len(outside) == len(boxes)
        yield self.found(
            "The camera looks at nothing: all displays are outside the view."
            if is_empty
            else f"Outside the view of every browser: {', '.join(outside)}.",
            "Focus on a display, or reset the view (Z).",
            severity=Severity.WARNING if is_empty else Severity.NOTE,
            evidence={"displays": tuple(outside)},
        )
