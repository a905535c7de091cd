"""The frame that is tried in another pose, and the lines that would make it last."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

from webviz.engine.state import State, WhatIf
from webviz.page.content.store import PageStore


class WhatIfStore(PageStore, frozen=True):
    """The frame that is tried in another pose; no field without one.

    Args:
        frame, parent: ids.
        fits: how well each scan of the frame lies on walls, sentences.
        urdf: the origin of its joint in a URDF.
        command: publishes it as a static transform.
        browser: that tries it, None for a program.
    """

    frame: str
    parent: str
    fits: Sequence[str]
    urdf: str
    command: str
    browser: int | None


def what_if(state: State, _: str) -> WhatIfStore | None:
    """Return the frame that is tried, None without one."""
    tried = state.what_if
    if tried is None:
        return None
    return WhatIfStore(
        frame=tried.frame,
        parent=tried.parent,
        fits=[
            f"{name}: {share:.0%} of {points} points on walls of {topic}"
            for name, (share, points, topic) in tried.fits.items()
        ],
        urdf=urdf_origin(tried),
        command=static_transform_publisher(tried),
        browser=tried.browser,
    )


def urdf_origin(tried: WhatIf) -> str:
    """Return the origin of the joint of a frame, for a URDF or xacro file."""
    xyz, rpy = (quoteattr(" ".join(map(_text, each))) for each in (tried.position, tried.rpy))
    return f"<origin xyz={xyz} rpy={rpy}/>"


def static_transform_publisher(tried: WhatIf) -> str:
    """Return the command that publishes the transform of a frame."""
    names = "x", "y", "z", "roll", "pitch", "yaw"
    values = zip(names, (*tried.position, *tried.rpy), strict=True)
    numbers = " ".join(f"--{name} {_text(value)}" for name, value in values)
    frames = f"--frame-id {shlex.quote(tried.parent)} --child-frame-id {shlex.quote(tried.frame)}"
    return f"ros2 run tf2_ros static_transform_publisher {numbers} {frames}"


def _text(value: float) -> str:
    """To a tenth of a millimetre or of a milliradian, without a negative zero."""
    return f"{round(value, 4) + 0.0:g}"
