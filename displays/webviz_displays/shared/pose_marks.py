"""Poses as arrows or axes."""

from __future__ import annotations

import numpy as np

from webviz import Context, Group
from webviz.api.nodes import Ids
from webviz_displays.shared.geometry import along_x
from webviz_displays.shared.pose_history import UNIT_TOLERANCE, PoseTrail
from webviz_displays.shared.pose_properties import PoseShape
from webviz_displays.shared.properties import opaque
from webviz_displays.shared.rods import add_solid_arrows


def draw_poses(
    look: PoseShape,
    poses: PoseTrail,
    group: Group,
    ctx: Context,
    ids: Ids | None = None,
    path: str = "alpha",
) -> None:
    """Draw poses in the coordinates of a group, and say if they are invisible.

    Args:
        look: properties.
        poses: to draw.
        group: where to draw.
        ctx: collects statuses.
        ids: (N,), of the samples; None if they are numbered from 0.
        path: of the property with the opacity.
    """
    if look.value == "Axes":
        group.axes("poses", poses.positions, poses.wxyzs, look.axes_length, look.axes_radius, ids)
        return
    if look.alpha == 0:
        ctx.warn(
            "Pose", "The arrows are invisible: alpha is 0. Increase it to show them.", opaque(path)
        )
        return
    length = look.shaft_length + look.head_length
    segments = along_x(poses.positions, poses.rotations, length)
    sizes = (look.shaft_radius, look.head_radius, look.head_length)
    if look.alpha < 1:
        add_solid_arrows(group, segments, look.color, *sizes, look.alpha, ids)
    else:
        group.arrows("poses", segments, look.color, *sizes, ids)


def report_orientations(squares: np.ndarray, noun: str, ctx: Context) -> None:
    """Warn about quaternions that are no rotations.

    Args:
        squares: squared lengths (N,) of the quaternions as sent.
        noun: what has them, such as "pose".
        ctx: collects the status.
    """
    zeros = int((squares == 0.0).sum())
    odd = int((np.abs(squares - 1.0) >= UNIT_TOLERANCE).sum()) - zeros
    total = f"of {len(squares)} {noun}s" if len(squares) > 1 else f"of the {noun}"
    if zeros:
        which = f"{zeros} {total}" if len(squares) > 1 else total.removeprefix("of ")
        ctx.warn(
            "Orientation",
            f"The orientation of {which} is all zeros and drawn without rotation. "
            "Set w to 1 in the publisher.",
        )
    elif odd:
        which = f"{odd} {total}" if len(squares) > 1 else total.removeprefix("of ")
        ctx.warn(
            "Orientation",
            f"The orientation of {which} is not normalised and drawn as if it were. "
            "Fix the publisher.",
        )
