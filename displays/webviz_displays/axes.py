"""The Axes display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from webviz import Context, Details, Display, Hit, Prop, Sample
from webviz_displays.shared.geometry import Metres
from webviz_displays.shared.properties import FIXED_FRAME, frame_of


class Axes(Display):
    """The axes of one frame: x red, y green, z blue."""

    rviz = "rviz_default_plugins/Axes"
    icon = "axes"

    reference_frame: Annotated[str, Prop(widget="frame", help="Frame whose axes are drawn.")] = (
        FIXED_FRAME
    )
    length: Annotated[Metres, Prop(help="Length of each axis.")] = 1.0
    radius: Annotated[Metres, Prop(rviz_factor=2.0, help="Radius of each axis.")] = 0.1

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Axes that follow the reference frame."""
        group = ctx.follow(frame_of(self.reference_frame))
        group.axes("axes", [(0.0, 0.0, 0.0)], [(1.0, 0.0, 0.0, 0.0)], self.length, self.radius)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the frame, and where it is."""
        frame = frame_of(self.reference_frame) or ctx.frames.fixed_frame
        pose = ctx.frames.latest(frame)
        values = {} if pose is None else {f"Pose in {ctx.frames.fixed_frame}": pose}
        return Details(f"Axes of {frame}", values | {"Length": f"{self.length:g} m"})
