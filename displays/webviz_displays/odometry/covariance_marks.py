"""Covariances as translucent solids and wedges."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from webviz import Context, Group, Mesh, Sample
from webviz.data.rotations import from_matrices
from webviz_displays.odometry.covariance import (
    LARGEST,
    WEDGE,
    Covariances,
    Placed,
    ellipses,
    ellipsoids,
    has_negative_variance,
    read,
    tip_discs,
    wedges,
)
from webviz_displays.shared.pose_history import PoseTrail
from webviz_displays.shared.pose_properties import (
    Covariance,
    OrientationCovariance,
    PositionCovariance,
)

F64 = NDArray[np.float64]
Ids = NDArray[np.intp]

MAX_COVARIANCES = 100
"""RViz's default Keep. Each covariance is several transparent solids, which browsers sort."""

THICKNESS = 1e-3
"""Thickness of ellipses and discs, metres, as in RViz."""

_RGB = ((255, 0, 0), (0, 255, 0), (0, 0, 255))


def draw_covariances(
    look: Covariance,
    samples: Sequence[Sample],
    poses: PoseTrail,
    group: Group,
    ctx: Context,
    ids: Ids,
) -> None:
    """Draw the covariances of the newest poses, if they are switched on, and report invalid ones.

    Args:
        look: properties.
        samples: of N messages with a PoseWithCovariance named `pose`, oldest first.
        poses: theirs, in the coordinates of the group.
        group: where to draw.
        ctx: collects statuses.
        ids: (N,), of the poses.
    """
    if not look.value:
        return
    newest = [sample.message.pose.covariance for sample in samples[-MAX_COVARIANCES:]]
    rows, total = np.array(newest), len(samples)
    covariances, ok = read(rows)
    negative = has_negative_variance(rows)
    if not ok.all():
        ctx.warn(
            "Covariance",
            f"{(~ok).sum()} of {len(ok)} covariances are invalid and not drawn: not finite, "
            f"larger than {LARGEST:g}, or with a negative eigenvalue. Fix the publisher.",
        )
    elif negative.any():
        ctx.warn(
            "Covariance",
            f"{negative.sum()} of {len(ok)} covariances have a negative variance of z, roll "
            "or pitch, which counts as 0. Publish 0 if the robot moves in a plane.",
        )
    elif total > len(newest):
        ctx.ok("Covariance", f"Showing the newest {len(newest)} of {total} covariances.")
    covariances = Covariances(covariances.matrices[ok], covariances.is_planar[ok])
    frames_shown, ids = poses[-len(newest) :][ok], ids[-len(newest) :][ok]
    if look.position.value:
        add_positions(
            group, look.position, covariances, frames_shown.positions, frames_shown.frames, ids
        )
    if look.orientation.value:
        axes = frames_shown.rotations if look.orientation.frame == "Local" else frames_shown.frames
        add_orientations(group, look.orientation, covariances, frames_shown.positions, axes, ids)


def add_positions(
    group: Group,
    look: PositionCovariance,
    covariances: Covariances,
    positions: F64,
    frames: F64,
    ids: Ids,
) -> None:
    """Draw ellipses and ellipsoids around N positions.

    Args:
        group: where to draw.
        look: properties.
        covariances: in the axes of `frames`.
        positions: (N, 3), metres.
        frames: (N, 3, 3), rotations.
        ids: (N,), of the poses.
    """
    flat = ellipses(covariances, positions, frames, look.scale)
    full = ellipsoids(covariances, positions, frames, look.scale)
    if len(flat.centers):
        scales, wxyzs = _turned(flat)
        scales[:, 2] = THICKNESS
        group.instances(
            "ellipses",
            "cylinder",
            flat.centers,
            scales,
            look.color,
            wxyzs,
            look.alpha,
            ids=ids[covariances.is_planar],
        )
    if len(full.centers):
        scales, wxyzs = _turned(full)
        group.instances(
            "ellipsoids",
            "sphere",
            full.centers,
            scales,
            look.color,
            wxyzs,
            look.alpha,
            ids=ids[~covariances.is_planar],
        )


def add_orientations(
    group: Group,
    look: OrientationCovariance,
    covariances: Covariances,
    positions: F64,
    axes: F64,
    ids: Ids,
) -> None:
    """Draw wedges and discs at N poses.

    As in RViz each disc has the colour of the axis whose tip it surrounds; yaw alone is blue.

    Args:
        group: where to draw.
        look: properties.
        covariances: covariances of rotations about `axes`.
        positions: (N, 3), metres.
        axes: (N, 3, 3), rotations.
        ids: (N,), of the poses.
    """
    colors = (look.color,) * 3 if look.color_style == "Unique" else _RGB
    yaws = wedges(covariances, positions, axes, look.scale, look.offset)
    if len(yaws.centers):
        vertices = yaws.images(WEDGE).reshape(-1, 3).astype(np.float32)
        faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
        group.add("wedges", Mesh(vertices, faces, colors[2], look.alpha))
    discs = [tip_discs(covariances, positions, axes, look.scale, look.offset, i) for i in (0, 1, 2)]
    placed = Placed(*map(np.concatenate, zip(*discs, strict=True)))
    if len(placed.centers):
        scales, wxyzs = _turned(placed)
        scales[:, 2] = THICKNESS
        each = np.repeat(np.array(colors, np.uint8), len(discs[0].centers), axis=0)
        group.instances(
            "discs",
            "cylinder",
            placed.centers,
            scales,
            each,
            wxyzs,
            look.alpha,
            ids=np.tile(ids[~covariances.is_planar], 3),
        )


def _turned(placed: Placed) -> tuple[F64, F64]:
    """Diameters (N, 3) along the axes of shapes of radius 1, and the turns (N, 4) of these axes.

    The columns of the frames are orthogonal, none is zero. Where they are left-handed the last one
    is reversed: all these shapes are symmetric.
    """
    lengths = np.linalg.norm(placed.frames, axis=1)
    m = placed.frames / lengths[:, None, :]
    m[:, :, 2] *= np.sign(np.linalg.det(m))[:, None]
    return 2 * lengths, from_matrices(m)
