"""The displays BoundingBox3D and BoundingBox3DArray."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from webviz import Color, Context, Details, Hit, Input, Prop, Sample, Topic
from webviz_displays.detections.boxes import BoxesDisplay


class _OfOneColor(BoxesDisplay):
    """Base of displays of boxes that nothing is known of."""

    color: Annotated[Color, Prop(help="Colour of the boxes.")] = (255, 255, 0)

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the boxes of a message."""
        return message.boxes

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw them in one colour."""
        boxes = self.boxes_of(sample.message)
        count = len(boxes)
        self.draw_boxes(boxes, [self.color] * count, [""] * count, sample, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the size of a box."""
        size = self.boxes_of(hit.sample.message)[hit.id].size
        return Details(f"Box {hit.id}", {"Size": f"{size.x:g} x {size.y:g} x {size.z:g} m"})


class BoundingBox3DArray(_OfOneColor):
    """Boxes in one frame."""

    rviz = "vision_msgs_rviz_plugins/BoundingBox3DArray"

    topic: Annotated[
        Topic, Input("vision_msgs/msg/BoundingBox3DArray"), Prop(help="Topic of the boxes.")
    ] = Topic("/bounding_box_3d_array")


class BoundingBox3D(_OfOneColor):
    """A box in the fixed frame: its message names no frame."""

    rviz = "vision_msgs_rviz_plugins/BoundingBox3D"

    topic: Annotated[
        Topic, Input("vision_msgs/msg/BoundingBox3D"), Prop(help="Topic of the boxes.")
    ] = Topic("/bounding_box_3d")

    def boxes_of(self, message: Any) -> Sequence[Any]:
        """Return the box itself."""
        return (message,)
