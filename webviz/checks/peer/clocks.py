"""Clocks of two machines."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

MAX_OFFSET_S = 0.05
"""Transforms at 20 Hz are as far apart."""


class PeerClock(Check):
    """Clock of the peer differs.

    The clocks of this machine and of its peer differ by more than 50 ms.

    Why:
        Stamps of the other machine lie in the future or in the past here, so that no transform fits
        them and displays wait, or show nothing.

    Repair:
        Synchronise both clocks, with chrony or NTP:

            sudo apt install chrony
            chronyc sources
    """

    id = "TIME020"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so, beyond the uncertainty of the measurement."""
        ends = observation.ends
        if ends is None or abs(ends.offset_s) - ends.uncertainty_s <= MAX_OFFSET_S:
            return
        direction = "ahead of" if ends.offset_s > 0 else "behind"
        yield self.found(
            f"The clock of {ends.there.host} is {abs(ends.offset_s):.3g} s {direction} that of "
            f"this machine (± {ends.uncertainty_s:.2g} s).",
            "Synchronise both clocks with chrony.",
            subject=ends.there.host,
            evidence={
                "offset_s": round(ends.offset_s, 6),
                "uncertainty_s": round(ends.uncertainty_s, 6),
            },
            command="chronyc sources",
        )
