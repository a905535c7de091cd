"""Displays of vision_msgs: boxes around what was detected."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from webviz import Color, Context, Details, Hit, Input, Prop, Sample, Topic
from webviz_displays.detections.boxes import BoxesDisplay

__all__ = ["BoundingBox3D", "BoundingBox3DArray", "Detection3D", "Detection3DArray"]

# Colours of vision_msgs_rviz_plugins.
COLORS = {
    "car": (255, 165, 0),
    "person": (0, 0, 255),
    "cyclist": (255, 255, 0),
    "motorcycle": (230, 230, 250),
}
OTHER = (190, 190, 190)
UNKNOWN = (255, 22, 80)
"""Colour of a detection without a class."""
MAX_TEXT = 80
"""Characters of a class above a box."""


class _Detections(BoxesDisplay):
    """Base of displays of detections."""

    show_score: Annotated[bool, Prop(help="Show the score of the likeliest class.")] = False
    show_class: Annotated[bool, Prop(help="Show the likeliest class.")] = False

    def detections_of(self, message: Any) -> Sequence[Any]:
        """Return the detections of a message."""
        return message.detections

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw each in the colour of its likeliest class."""
        detections = self.detections_of(sample.message)
        best = [_best(each) for each in detections]
        boxes, colors = [each.bbox for each in detections], [_color(each) for each in best]
        self.draw_boxes(boxes, colors, [self._text(each) for each in best], sample, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the classes of a detection by their scores, and its size."""
        detection = self.detections_of(hit.sample.message)[hit.id]
        results = sorted(detection.results, key=lambda each: -each.hypothesis.score)[:5]
        size = detection.bbox.size
        values: dict[str, object] = {"Size": f"{size.x:g} x {size.y:g} x {size.z:g} m"}
        values |= {each.hypothesis.class_id: f"{each.hypothesis.score:.2f}" for each in results}
        return Details(f"Detection {detection.id or hit.id}", values)

    def _text(self, best: Any | None) -> str:
        if best is None:
            return ""
        parts = [best.class_id[:MAX_TEXT]] if self.show_class else []
        parts += [f"{best.score:.2f}"] if self.show_score else []
        return " ".join(parts)


class Detection3DArray(_Detections):
    """Detections of a camera or lidar: boxes in the colours of their classes."""

    rviz = "vision_msgs_rviz_plugins/Detection3DArray"

    topic: Annotated[
        Topic, Input("vision_msgs/msg/Detection3DArray"), Prop(help="Topic of the detections.")
    ] = Topic("/detection3_d_array")


class Detection3D(_Detections):
    """One detection: a box in the colour of its class."""

    rviz = "vision_msgs_rviz_plugins/Detection3D"

    topic: Annotated[
        Topic, Input("vision_msgs/msg/Detection3D"), Prop(help="Topic of the detections.")
    ] = Topic("/detection3_d")

    def detections_of(self, message: Any) -> Sequence[Any]:
        """Return the detection itself."""
        return (message,)


def _best(detection: Any) -> Any | None:
    """Return the likeliest hypothesis, None without any."""
    hypotheses = [each.hypothesis for each in detection.results]
    return max(hypotheses, key=lambda each: each.score, default=None)


def _color(best: Any | None) -> tuple[int, int, int]:
    return (
        UNKNOWN if best is None or not best.class_id else COLORS.get(best.class_id.lower(), OTHER)
    )


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
