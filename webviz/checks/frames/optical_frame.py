"""Optical frames that are not rotated."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

ENDINGS = "optical_frame", "_optical"
UPRIGHT = 0.996
"""Cosine of half of 10 degrees."""


class OpticalFrame(Check):
    """Optical frame like a body frame.

    A frame whose name ends in "optical_frame" is not rotated against its parent.

    Why:
        In an optical frame z looks forward and y down (REP 103), in a body frame x looks forward
        and z up. Without the rotation, clouds of a camera lie on their side.

    Repair:
        Rotate the joint of the frame in the URDF:

            <origin rpy="-1.5708 0 -1.5708"/>
    """

    id = "TF025"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for frame in observation.buffer.publishers:
            link = observation.buffer.link(frame) if frame.endswith(ENDINGS) else None
            if link is None or link.parent.endswith(ENDINGS):
                continue
            w = abs(link.transform.rotation[3])
            if w >= UPRIGHT:
                yield self.found(
                    f'"{frame}" is not rotated against "{link.parent}", though it is optical.',
                    "Rotate it by roll -90 and yaw -90 degrees in the URDF.",
                    subject=frame,
                    evidence={"parent": link.parent},
                )
