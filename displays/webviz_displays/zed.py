"""The ZedOdDisplay display."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Pose,
    Prop,
    Remedy,
    Sample,
    Topic,
    compose,
)
from webviz.data.words import counted
from webviz_displays.shared.geometry import BOX_EDGES, LONGEST, is_drawable, origin_near


class Skeleton(msgspec.Struct, frozen=True, eq=False):
    """A format of skeletons of the ZED SDK: its BODY_18, BODY_34, BODY_38 and BODY_70.

    Args:
        joints: how many of the keypoints of a message are joints.
        bones: (M, 2), the joints at the ends of each bone.
    """

    joints: int
    bones: NDArray[np.intp]


def _body(joints: int, *chains: tuple[int, ...]) -> Skeleton:
    return Skeleton(
        joints, np.array([bone for chain in chains for bone in pairwise(chain)], np.intp)
    )


_TRUNK = (
    *((0, 1, 2, 3, 4, 5), (5, 6, 8), (5, 7, 9)),
    *((3, 10, 12, 14, 16), (3, 11, 13, 15, 17)),
    *((0, 18, 20, 22), (22, 24), (22, 26), (22, 28)),
    *((0, 19, 21, 23), (23, 25), (23, 27), (23, 29)),
)
"""Chains of joints from the pelvis to the face, the wrists and the feet."""

BODIES = (
    _body(
        18,
        *((0, 1, 2, 3, 4), (1, 5, 6, 7), (2, 5), (2, 8, 9, 10), (5, 11, 12, 13), (8, 11)),
        *((0, 14, 16), (0, 15, 17)),
    ),
    _body(
        34,
        *((0, 1, 2, 4, 5, 6, 7, 8, 9), (7, 10), (2, 11, 12, 13, 14, 15, 16), (14, 17)),
        *((0, 18, 19, 20, 21), (20, 32, 21), (0, 22, 23, 24, 25), (24, 33, 25)),
        *((2, 3, 26, 27, 28, 29), (27, 30, 31)),
    ),
    _body(
        38,
        *_TRUNK,
        *((16, tip) for tip in range(30, 38, 2)),
        *((17, tip) for tip in range(31, 38, 2)),
    ),
    _body(70, *_TRUNK, *((16, j) for j in range(30, 50)), *((17, j) for j in range(50, 70))),
)
"""Bones by the `body_format` of a message."""


F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]
Rows = NDArray[np.intp]

MAX_OBJECTS = 1000
"""Objects drawn per message."""
PIVOT = 0.02
"""Diameter of the sphere at the position of an object, and height of its label per Label Scale."""
OF_SKELETONS = 0.4
"""Joints and links of skeletons, as a share of those of boxes."""

TRACKED = 1
TRACKING = ("off", "tracked", "searching", "terminated")
"""Names by `tracking_state`."""
TRACKING_COLORS = ((0, 0, 0), (0, 255, 0), (128, 89, 0), (255, 255, 255))
"""Colours of corners, by `tracking_state`."""


class ZedOdDisplay(Display):
    """Objects and people that a ZED camera detects: boxes, skeletons and labels."""

    rviz = "rviz_plugin_zed_od/ZedOdDisplay"

    topic: Annotated[
        Topic, Input("zed_msgs/msg/ObjectsStamped"), Prop(help="Topic of the objects.")
    ] = Topic("/zed/zed_node/obj_det/objects")
    transparency: Annotated[
        float, Prop(ge=0, le=1, help="Transparency of lines and joints; 1 is invisible.")
    ] = 0.25
    show_skeletons: Annotated[bool, Prop(help="Draw the skeletons of people.")] = True
    show_labels: Annotated[bool, Prop(help="Show the number and the kind of each object.")] = True
    show_bounding_boxes: Annotated[bool, Prop(help="Draw a box around each object.")] = True
    link_size: Annotated[
        float, Prop(ge=0.01, le=1, unit="m", help="Width of the edges of boxes.")
    ] = 0.05
    joint_radius: Annotated[
        float, Prop(gt=0, le=LONGEST, unit="m", help="Diameter of the corners of boxes.")
    ] = 0.1
    label_scale: Annotated[float, Prop(ge=0.5, le=15, help="Height of labels, in 2 cm.")] = 5.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the objects that are tracked, in the frame and at the stamp of the header."""
        objects: Sequence[Any] = sample.message.objects
        tracked = [row for row, each in enumerate(objects) if _is_tracked(each)]
        positions = np.array([objects[row].position for row in tracked], np.float64).reshape(-1, 3)
        is_placed = is_drawable(positions)
        rows = np.array(tracked, np.intp)[is_placed][:MAX_OBJECTS]
        self._report(len(objects), len(tracked), int(is_placed.sum()), ctx)
        if not len(rows):
            return
        chosen = [objects[row] for row in rows]
        positions = positions[is_placed][:MAX_OBJECTS]
        origin = np.array(origin_near(positions))
        group = ctx.follow(None, offset=compose(sample.pose, Pose(tuple(origin.tolist()))))
        colors = np.array([box_color(each.label_id) for each in chosen], np.uint8)
        if self.show_labels:
            xyz = positions - origin
            group.instances("pivots", "sphere", xyz, PIVOT, colors, ids=rows)
            texts = tuple(map(label_of, chosen))
            group.labels("labels", xyz, texts, PIVOT * self.label_scale, ids=rows)
        if self.show_bounding_boxes:
            self._draw_boxes(chosen, rows, colors, origin, group, ctx)
        if self.show_skeletons:
            self._draw_skeletons(chosen, rows, colors, origin, group, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return an object: what it is, how sure that is, and how it moves."""
        detected = hit.sample.message.objects[hit.id]
        x, y, z = detected.velocity.tolist()
        values: dict[str, object] = {
            "Kind": " > ".join(filter(None, (detected.label, detected.sublabel))),
            "Confidence": f"{detected.confidence:g} %",
            "Velocity": f"{x:g}, {y:g}, {z:g} m/s",
            "Size": " x ".join(f"{metres:g}" for metres in detected.dimensions_3d.tolist()) + " m",
        }
        if detected.tracking_available:
            values["Tracking"] = TRACKING[_state_of(detected)]
        return Details(label_of(detected), values)

    def _draw_boxes(
        self,
        objects: Sequence[Any],
        rows: Rows,
        colors: U8,
        origin: F64,
        group: Group,
        ctx: Context,
    ) -> None:
        corners = np.array([each.bounding_box_3d.corners for each in objects], np.float64)
        ok = is_drawable(corners).all(axis=1)
        if invalid := int((~ok).sum()):
            text = f"{invalid} of {len(objects)} boxes left out: corners are missing or invalid."
            ctx.warn("Boxes", text)
        corners, rows = corners[ok] - origin, rows[ok]
        if not len(rows):
            return
        states = np.array([_state_of(each) for each in objects], np.intp)[ok]
        self._lines("boxes", corners[:, BOX_EDGES], colors[ok], rows, self.link_size, group)
        group.instances(
            "corners",
            "sphere",
            corners.reshape(-1, 3),
            self.joint_radius,
            np.repeat(np.array(TRACKING_COLORS, np.uint8)[states], 8, axis=0),
            ids=np.repeat(rows, 8),
        )

    def _draw_skeletons(
        self,
        objects: Sequence[Any],
        rows: Rows,
        colors: U8,
        origin: F64,
        group: Group,
        ctx: Context,
    ) -> None:
        bright = np.clip(colors + np.array((100, 50, -50)), 0, 255).astype(np.uint8)
        bones, joints, bone_of, joint_of = [], [], [], []
        for number, each in enumerate(objects):
            if not each.skeleton_available:
                continue
            if not 0 <= each.body_format < len(BODIES):
                text = f"Body format {each.body_format} is unknown. Fix the publisher."
                ctx.warn("Skeletons", text)
                continue
            body = BODIES[each.body_format]
            xyz = np.asarray(each.skeleton_3d.keypoints[: body.joints], np.float64)
            ok = is_drawable(xyz)
            linked = body.bones[ok[body.bones].all(axis=1)]
            joints.append(xyz[ok] - origin)
            bones.append(xyz[linked] - origin)
            joint_of += [number] * len(joints[-1])
            bone_of += [number] * len(linked)
        if not joints:
            return
        segments = np.concatenate(bones)
        width = OF_SKELETONS * self.link_size
        self._lines("bones", segments[:, None], bright[bone_of], rows[bone_of], width, group)
        group.instances(
            "joints",
            "sphere",
            np.concatenate(joints),
            OF_SKELETONS * self.joint_radius,
            bright[joint_of],
            opacity=1.0 - self.transparency,
            ids=rows[joint_of],
        )

    def _lines(
        self, key: str, segments: F64, colors: U8, rows: Rows, width: float, group: Group
    ) -> None:
        """Draw lines (N, k, 2, 3) of N items, whose colours are (N, 3)."""
        each = segments.shape[1]
        ends = np.repeat(colors, 2 * each, axis=0).reshape(-1, 2, 3)
        ids, opacity = np.repeat(rows, each), 1.0 - self.transparency
        group.lines(key, segments, ends, width, "m", ids, opacity)

    def _report(self, total: int, tracked: int, placed: int, ctx: Context) -> None:
        reasons = [
            f"{count} {why}"
            for count, why in (
                (total - tracked, "not tracked"),
                (tracked - placed, "without a position"),
                (placed - min(placed, MAX_OBJECTS), "too many"),
            )
            if count
        ]
        left_out = f": {', '.join(reasons)}" if reasons else ""
        amounts = f"{min(placed, MAX_OBJECTS)} of {counted(total, 'object')} shown{left_out}."
        if not total:
            ctx.warn("Objects", "No objects in the newest message.")
        elif not (self.show_labels or self.show_bounding_boxes or self.show_skeletons):
            remedy = Remedy("show_bounding_boxes", True, "Show bounding boxes")
            ctx.warn("Objects", "Boxes, skeletons and labels are switched off.", remedy)
        elif not placed or placed < tracked or placed > MAX_OBJECTS:
            ctx.warn("Objects", amounts)
        else:
            ctx.ok("Objects", amounts)


def box_color(label_id: int) -> tuple[int, int, int]:
    """Return the colour of an object, by its number, as in Stereolabs' plug-in."""
    step = 2 if label_id == -1 else label_id + 2
    return 30 * step % 256, 60 * step % 256, 120 * step % 256


def label_of(item: Any) -> str:
    """Return the label of an object: its number and kind."""
    number = "" if item.label_id == -1 else str(item.label_id)
    if item.skeleton_available:
        return "-".join(filter(None, ("Person", number)))
    kind = item.label
    if item.sublabel != item.label:
        kind += f" [{item.sublabel}]"
    return f"{number}-{kind}" if number else kind


def _is_tracked(item: Any) -> bool:
    """Return whether an object is shown: while tracking is on, only those in sight."""
    if not item.tracking_available:
        return True
    return item.label_id != -1 and item.tracking_state == TRACKED


def _state_of(item: Any) -> int:
    """Return the tracking state of an object; unknown ones count as off."""
    return item.tracking_state if 0 <= item.tracking_state < len(TRACKING) else 0
