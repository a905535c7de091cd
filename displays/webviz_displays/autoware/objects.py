"""The displays DetectedObjects, TrackedObjects and PredictedObjects."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Pose,
    Prop,
    Rgb,
    Sample,
    Topic,
    compose,
)
from webviz.data.rotations import normalized, w_first
from webviz.data.words import counted
from webviz_displays.autoware.object_shapes import (
    BOX,
    CYLINDER,
    arrowheads,
    ellipse,
    heading,
    interval,
    outline,
    sector,
)
from webviz_displays.autoware.objects_look import (
    ClassColors,
    MeasuredTexts,
    ObjectCovariances,
    ObjectVectors,
    PredictedPaths,
    ShapeView,
    TrackedTexts,
)
from webviz_displays.autoware.seen_object import SeenObject, object_of
from webviz_displays.autoware.sketch import ObjectSketch
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import LONGEST, is_drawable, origin_near

F64 = NDArray[np.float64]

MAX_OBJECTS = 500
"""Objects drawn per message."""
MAX_PATHS, MAX_POSES = 10, 100
"""Paths drawn per object, and poses per path."""
ABOVE, BELOW, LOWER, LOWEST = (np.array((shift, 0.0, shift)) for shift in (0.5, -0.5, -1.0, -1.5))
"""Places of texts beside the centre of an object."""
FILLED = 0.75
"""Largest opacity of solids."""
ANGLES = {"70%": 1.036, "85%": 1.440, "95%": 1.960, "99%": 2.576}
AREAS = {"70%": 1.552, "85%": 1.802, "95%": 2.448, "99%": 3.035}
"""Standard deviations of a confidence interval, of one number and of two."""
RED, PINK, WHITE = (255, 0, 0), (255, 51, 102), (255, 255, 255)
POSITION, VELOCITY = (204, 204, 204), (51, 102, 230)
"""Colours of ellipses."""
PATH_WIDTH = 0.015
PATH_COLORS: tuple[Rgb, ...] = (
    *((255, 166, 0), (255, 255, 0), (176, 255, 46), (150, 255, 150)),
    *((128, 255, 0), (0, 255, 255), (135, 207, 250), (255, 105, 181)),
)
"""Colours of paths, by the id of their object."""


class ObjectsDisplay(Display):
    """Base of the displays of Autoware's objects."""

    topic: Annotated[Topic, Prop(help="Topic of the objects.")] = Topic()
    line_width: Annotated[
        float, Prop(gt=0, le=LONGEST, unit="m", rviz="Line Width", help="Width of edges.")
    ] = 0.03
    color: Annotated[Color, Prop(help="Colour of all classes, unless each has one.")] = (
        255,
        255,
        255,
    )
    per_class_color: Annotated[ClassColors, Prop(help="One colour per class of objects.")] = (
        ClassColors()
    )
    alpha: Annotated[Alpha, Prop(help="Opacity of shapes.")] = 0.999
    shape: Annotated[ShapeView, Prop(help="How to draw the shapes.")] = ShapeView()
    vector: Annotated[ObjectVectors, Prop(help="Velocities as lines.")] = ObjectVectors()
    covariance: Annotated[ObjectCovariances, Prop(help="How uncertain each is.")] = (
        ObjectCovariances()
    )

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the objects, in the frame and at the stamp of the header."""
        objects: Sequence[Any] = sample.message.objects
        chosen = [(number, each) for number, each in enumerate(objects) if self.is_wanted(each)]
        candidates = [object_of(number, each) for number, each in chosen[:MAX_OBJECTS]]
        valid = [each for each in candidates if each is not None]
        self._report(len(objects), len(chosen), len(candidates) - len(valid), ctx)
        if not valid:
            return
        sketch = ObjectSketch()
        for each in valid:
            color = self.per_class_color.of(each.name) if self.per_class_color.value else self.color
            self._sketch_shape(each, color, sketch)
            self._sketch_vectors(each, sketch)
            self._sketch_covariances(each, sketch)
            self.sketch_texts(each, color, sketch)
            self.sketch_more(each, sketch)
        origin = np.array(origin_near([each.xyz for each in valid]))
        group = ctx.follow(None, offset=compose(sample.pose, Pose(tuple(origin.tolist()))))
        self._draw(sketch, origin, group)

    def is_wanted(self, item: Any) -> bool:
        """Return whether an object of a message is to be shown."""
        return True

    def sketch_texts(self, each: SeenObject, color: Rgb, sketch: ObjectSketch) -> None:
        """Add the texts of an object."""
        raise NotImplementedError

    def sketch_more(self, each: SeenObject, sketch: ObjectSketch) -> None:
        """Add what only some kinds of objects have."""

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return an object: its class, how sure it is, its size and speed."""
        message_object = hit.sample.message.objects[hit.id]
        detected = object_of(hit.id, message_object)
        if detected is None:
            return None
        values: dict[str, object] = {
            "Probability": f"{100 * detected.probability:.0f} %",
            "Size": " x ".join(f"{metres:g}" for metres in detected.size.tolist()) + " m",
            "Speed": f"{detected.speed:.2f} m/s",
        }
        if detected.uuid:
            values["Id"] = detected.uuid
        return Details(detected.title, values)

    def _sketch_shape(self, each: SeenObject, color: Rgb, sketch: ObjectSketch) -> None:
        look = self.shape
        if look.shape_type == "None":
            return
        if look.shape_type == "Fill" and each.kind in (BOX, CYLINDER):
            sketch.solids.append((each, color))
            return
        is_flat = look.shape_type == "Skeleton 2D"
        parts = [outline(each.kind, each.size, each.footprint, is_flat)]
        if each.kind == BOX:
            parts.append(heading(each.size, each.is_known, is_flat))
            if look.bbox_footprint and len(each.footprint):
                parts.append(outline(-1, each.size, each.footprint, is_flat))
        sketch.add("shapes", each.placed(np.concatenate(parts)), color, each.number)

    def _sketch_vectors(self, each: SeenObject, sketch: ObjectSketch) -> None:
        if self.vector.twist and each.speed:
            line = np.stack((np.zeros(3), each.velocity))[None]
            sketch.add("velocities", each.placed(line), RED, each.number)
        if self.vector.yaw_rate and each.speed and each.yaw_rate:
            start = math.atan2(each.velocity[1], each.velocity[0])
            turn = min(max(each.yaw_rate, -2 * math.pi), 2 * math.pi)
            edges = sector(start, start + turn, 0.8 * each.speed)
            sketch.add("yaw rates", each.placed(edges), RED, each.number)

    def _sketch_covariances(self, each: SeenObject, sketch: ObjectSketch) -> None:
        look, number = self.covariance, each.number
        angles, areas = ANGLES[look.confidence_interval], AREAS[look.confidence_interval]
        yaw = math.atan2(each.turn[1, 0], each.turn[0, 0])
        if look.pose and (ellipse_of := ellipse(each.pose_covariance[:2, :2])):
            first, second, angle = ellipse_of
            axes = areas * first, areas * second, angle
            sketch.ellipses.append((each.xyz, axes, _density(3.0, ellipse_of), POSITION, number))
        if look.twist and (ellipse_of := ellipse(each.twist_covariance[:2, :2])):
            first, second, angle = ellipse_of
            axes = areas * first, areas * second, angle + yaw
            tip = each.placed(each.velocity * (1.0, 1.0, 0.0))
            sketch.ellipses.append((tip, axes, _density(1.0, ellipse_of), VELOCITY, number))
        if look.yaw and (half := angles * _deviation(each.pose_covariance[5, 5])):
            half, radius = min(half, math.pi), max(0.65 * each.size[0], 1.0)
            sketch.add("yaws", each.placed(sector(-half, half, radius)), WHITE, number)
        if look.yaw_rate and (half := angles * _deviation(each.twist_covariance[5, 5])):
            middle = math.atan2(each.velocity[1], each.velocity[0]) + each.yaw_rate
            lines = interval(middle, min(half, math.pi), 0.8 * each.speed)
            sketch.add("yaw rate intervals", each.placed(lines), PINK, number)

    def _draw(self, sketch: ObjectSketch, origin: F64, group: Group) -> None:
        for key, share, opacity in (
            ("shapes", 1.0, self.alpha),
            ("velocities", 1.0, 1.0),
            ("yaw rates", 0.4, 0.9),
            ("yaws", 0.5, 0.9),
            ("yaw rate intervals", 0.3, 0.9),
        ):
            sketch.draw_lines(key, share * self.line_width, opacity, origin, group)
        sketch.draw_lines("paths", PATH_WIDTH, 0.6, origin, group)
        sketch.draw_lines("path footprints", PATH_WIDTH, 0.5, origin, group)
        sketch.draw_solids(min(self.alpha, FILLED), origin, group)
        sketch.draw_ellipses(origin, group)
        sketch.draw_texts(origin, group)

    def _report(self, total: int, matching: int, invalid: int, ctx: Context) -> None:
        if not total:
            ctx.warn("Objects", "No objects in the newest message.")
        elif not matching:
            text = f"None of {counted(total, 'object')} has this Dynamic Status."
            ctx.warn("Objects", text)
        elif invalid:
            text = f"{invalid} of {counted(matching, 'object')} left out: the pose or shape is"
            ctx.warn("Objects", f"{text} not finite or too large. Fix the publisher.")
        elif matching > MAX_OBJECTS:
            ctx.warn("Objects", f"Showing the first {MAX_OBJECTS} of {matching} objects.")
        else:
            ctx.ok("Objects", f"{counted(matching, 'object')}.")


class DetectedObjects(ObjectsDisplay):
    """Objects that Autoware detects, before it follows them over time."""

    rviz = "autoware_perception_rviz_plugin/DetectedObjects"

    topic: Annotated[
        Topic,
        Input("autoware_perception_msgs/msg/DetectedObjects"),
        Prop(help="Topic of the objects."),
    ] = Topic("/perception/object_recognition/detection/objects")
    text: Annotated[MeasuredTexts, Prop(help="Texts at the objects.")] = MeasuredTexts()

    def sketch_texts(self, each: SeenObject, color: Rgb, sketch: ObjectSketch) -> None:
        """Add class, speed and probability."""
        if self.text.label:
            sketch.texts.append((each.xyz, each.name, color, each.number))
        if self.text.velocity:
            sketch.texts.append((each.xyz + BELOW, _speed(each), color, each.number))
        if self.text.existence_probability:
            text = f"{each.probability:.3f}"
            sketch.texts.append((each.xyz + ABOVE, text, color, each.number))


class IdentifiedObjects(ObjectsDisplay):
    """Base of the displays of objects with an id."""

    text: Annotated[TrackedTexts, Prop(help="Texts at the objects.")] = TrackedTexts()

    def sketch_texts(self, each: SeenObject, color: Rgb, sketch: ObjectSketch) -> None:
        """Add class, id, speed, acceleration and probability."""
        texts = []
        if self.text.label:
            texts.append((each.xyz, each.name))
        if self.text.uuid:
            texts.append((each.xyz + BELOW, each.uuid[:4]))
        if self.text.velocity:
            texts.append((each.xyz + LOWER, _speed(each)))
        if self.text.acceleration and each.acceleration is not None:
            size = float(np.linalg.norm(each.acceleration))
            texts.append((each.xyz + LOWEST, f"{size:.1f}[m/s^2]"))
        if self.text.existence_probability:
            texts.append((each.xyz + ABOVE, f"{each.probability:.3f}"))
        sketch.texts += [(place, text, color, each.number) for place, text in texts]


class TrackedObjects(IdentifiedObjects):
    """Objects that Autoware follows over time."""

    rviz = "autoware_perception_rviz_plugin/TrackedObjects"

    topic: Annotated[
        Topic,
        Input("autoware_perception_msgs/msg/TrackedObjects"),
        Prop(help="Topic of the objects."),
    ] = Topic("/perception/object_recognition/tracking/objects")
    dynamic_status: Annotated[
        Literal["All", "Dynamic", "Static"], Prop(help="Show only objects that move or stand.")
    ] = "All"

    def is_wanted(self, item: Any) -> bool:
        """Return whether the object's motion is among those that are drawn."""
        if self.dynamic_status == "All":
            return True
        return item.kinematics.is_stationary == (self.dynamic_status == "Static")


class PredictedObjects(IdentifiedObjects):
    """Objects with the paths that Autoware expects them to take."""

    rviz = "autoware_perception_rviz_plugin/PredictedObjects"

    topic: Annotated[
        Topic,
        Input("autoware_perception_msgs/msg/PredictedObjects"),
        Prop(help="Topic of the objects."),
    ] = Topic("/perception/object_recognition/objects")
    path: Annotated[PredictedPaths, Prop(help="How to draw the predicted paths.")] = (
        PredictedPaths()
    )

    def sketch_more(self, each: SeenObject, sketch: ObjectSketch) -> None:
        """Add the paths of an object, in the colour of its id."""
        step = 2 if self.path.path_resolution == "Simple" else 1
        color = PATH_COLORS[sum(each.uuid.encode()) % len(PATH_COLORS)]
        shape = outline(each.kind, each.size, each.footprint, is_flat=False)
        for path, confidence in each.paths[:MAX_PATHS]:
            xyz, xyzw = path.positions[:MAX_POSES], path.orientations[:MAX_POSES]
            if not len(xyz) or not is_drawable(xyz).all() or not np.isfinite(xyzw).all():
                continue
            yaws = _yaws(xyz, xyzw)
            if self.path.predicted_path and len(xyz) > 1:
                low = xyz - (0.0, 0.0, each.size[2] / 2)
                lines = np.stack((low[:-1], low[1:]), axis=1)
                marks = arrowheads(low[1:][::step], yaws[1:][::step])
                sketch.add("paths", np.concatenate((lines, marks)), color, each.number)
            if self.path.path_footprint:
                for place, yaw in zip(xyz[::step], yaws[::step].tolist(), strict=True):
                    turn = np.array(
                        (
                            (math.cos(yaw), -math.sin(yaw), 0.0),
                            (math.sin(yaw), math.cos(yaw), 0.0),
                            (0.0, 0.0, 1.0),
                        )
                    )
                    sketch.add("path footprints", shape @ turn.T + place, color, each.number)
            if self.path.path_confidence:
                sketch.texts.append((xyz[-1], f"{confidence:.6f}", color, each.number))


def _yaws(xyz: F64, xyzw: F64) -> F64:
    """Headings (N,) of poses; of those without an orientation, where the path goes."""
    wxyz, ok = normalized(w_first(xyzw))
    w, x, y, z = wxyz.T
    yaws = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    if len(xyz) > 1:
        steps = np.diff(xyz[:, :2], axis=0)
        ways = np.arctan2(steps[:, 1], steps[:, 0])
        is_given = ok & (np.abs(wxyz[:, 1:]) > 0).any(axis=1)
        yaws = np.where(is_given, yaws, np.append(ways[:1], ways))
    return yaws


def _speed(each: SeenObject) -> str:
    return f"{int(3.6 * each.speed)}[km/h]"


def _density(share: float, size: tuple[float, float, float]) -> float:
    """Return the opacity of an ellipse: the larger, the fainter."""
    return min(max(share / max(size[0] * size[1], 1e-9), 0.1), 0.5)


def _deviation(variance: float) -> float:
    """Return the standard deviation of a variance; 0 if the variance is invalid."""
    return math.sqrt(variance) if math.isfinite(variance) and variance > 0 else 0.0
