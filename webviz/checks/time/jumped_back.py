"""Time that jumped back."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class JumpedBack(Check):
    """Time jumped back.

    Data is older than transforms that have arrived before, and older transforms are refused.

    Why:
        tf2 keeps what is newest. After a bag starts again without /clock, everything in it is from
        the past.

    Repair:
        Press Reset, or play the bag with `--clock` and follow its time.
    """

    id = "TIME012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such link."""
        for symptom, reason in observation.unplaced(Kind.JUMPED_BACK):
            yield self.found(
                f'Time has jumped back: transforms of "{reason.link}" are refused as too old.',
                "Press Reset.",
                subject=reason.link,
                evidence={"frame": reason.frame, "link": reason.link},
                explains=(symptom,),
            )
