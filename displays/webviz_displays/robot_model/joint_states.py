"""The newest position of each joint, as its publishers report it."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz import Sample
from webviz.data import messages
from webviz.data.words import counted
from webviz_displays.shared.geometry import FARTHEST

MAX_JOINTS = 10_000
"""Joints whose positions are remembered; further names are ignored."""


class ReceivedRobot(msgspec.Struct, frozen=True):
    """Messages received about a robot.

    Args:
        description: its URDF, None before the first.
        positions: of joints by name, rad or m; finite.
        fault: why the newest joint state is invalid, or "".
    """

    description: str | None = None
    positions: Mapping[str, float] = msgspec.field(default_factory=dict)
    fault: str = ""

    def with_sample(self, name: str, sample: Sample) -> ReceivedRobot:
        """Return the same with a message of the input `name`."""
        if name == "description_topic":
            return replace(self, description=sample.message.data)
        positions, fault = positions_of(sample.message)
        room = MAX_JOINTS - len(self.positions)
        if room < len(positions):
            new = [joint for joint in positions if joint not in self.positions][max(room, 0) :]
            for joint in new:
                del positions[joint]
        return replace(self, positions={**self.positions, **positions}, fault=fault)


def positions_of(state: messages.JointState) -> tuple[dict[str, float], str]:
    """Return the valid positions in a joint state, and what is wrong with the others, or "".

    A state with velocities or efforts only has none.
    """
    names, positions = state.name, state.position
    if not len(positions):
        return {}, ""
    if len(names) != len(positions):
        named, amount = counted(len(names), "name"), counted(len(positions), "position")
        return {}, f"The joint state has {named} but {amount}. Fix its publisher."
    ok = np.abs(positions) < FARTHEST  # not NaN either
    fault = ""
    if not ok.all():
        first = names[int(np.argmin(ok))]
        fault = (
            f"{counted(int((~ok).sum()), 'position')} in the joint state cannot be drawn, such as "
            f"that of '{first}': {positions[int(np.argmin(ok))]:g}. Fix its publisher."
        )
    pairs = zip(names, positions.tolist(), ok.tolist(), strict=True)
    return {name: position for name, position, is_ok in pairs if is_ok}, fault
