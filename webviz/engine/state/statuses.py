"""Statuses of the viewer as a whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.explain import unknown_fixed_frame
from webviz.data.transforms.reasons import Explanation, Kind
from webviz.data.words import joined


def fixed_frame_status(fixed_frame: str, buffer: TransformBuffer) -> Status:
    """Return whether the fixed frame is known."""
    known = buffer.frames()
    if fixed_frame in known:
        return Status(Level.OK, "OK")
    if known:
        reason = unknown_fixed_frame(buffer, fixed_frame)
        other = reason.near or buffer.largest_tree()[0]
        return Status(Level.ERROR, reason.sentence, OtherFixedFrame(other), reason)
    text = (
        f"No transforms yet, so {fixed_frame} is unknown: {buffer.recorded}."
        if buffer.recorded
        else f"No transforms yet on /tf or /tf_static, so {fixed_frame} is unknown. Start a "
        "publisher of transforms, such as robot_state_publisher."
    )
    return Status(Level.WARN, text, reason=Explanation(Kind.NO_TRANSFORMS, text))


def import_status(report: Sequence[str]) -> Status:
    """Return the unsupported parts of a .rviz file, at least one sentence."""
    return Status(Level.WARN, joined("Parts of this .rviz file are unsupported.", *report))


def failures(crashes: Mapping[str, str]) -> dict[str, Status]:
    """Return the parts of the viewer that failed, by name."""
    return {
        part: Status(Level.ERROR, joined(text, "The log has the details; please report this."))
        for part, text in crashes.items()
    }


def without(broken: Mapping[str, str]) -> dict[str, Status]:
    """Return which features cannot be loaded, by name.

    Args:
        broken: the reasons by name.
    """
    return {
        f"Feature {name}": Status(Level.WARN, f"{name} is missing: {reason}. Install webviz anew.")
        for name, reason in broken.items()
    }
