"""The cloud of one node of RTAB-Map's graph."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from webviz import Pose
from webviz.data.images import CameraModel, ImageError
from webviz.data.rotations import normalized
from webviz_displays.map_cloud.compression import colors_of, depths_of, matrix_of
from webviz_displays.point_cloud2.decimation import one_per_voxel
from webviz_displays.shared.geometry import FARTHEST, is_drawable, transformed

U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]
F64 = NDArray[np.float64]

CHANNELS = {1: 2, 2: 3, 3: 5, 4: 6, 5: 3, 6: 4, 7: 4, 8: 6, 9: 7, 10: 7, 11: 5, 12: 6}
"""Number of channels of a scan, by its format in RTAB-Map's LaserScan.h."""
HEIGHTS = {5: 2, 6: 2, 7: 2, 8: 2, 9: 2, 10: 2, 11: 2, 12: 2}
"""Channel with z, by the format of a scan; other scans are flat."""
INTENSITIES = {2: 2, 4: 2, 6: 3, 9: 3, 11: 3, 12: 3}
"""Channel with intensities, by the format of a scan."""
BY_CHANNELS = {2: 1, 3: 5}
"""The formats of scans that name none."""


class CloudSettings(msgspec.Struct, frozen=True):
    """Choice of the points of a node.

    Args:
        from_scan: scans, instead of depth images.
        decimation: every how many rows and columns of depth images.
        min_depth, max_depth: limits in metres, 0 for none.
        voxel_m: edge of the cubes of which one point is kept; 0 keeps all.
        floor, ceiling: heights in metres between which points are kept, 0 for no limit.
    """

    from_scan: bool
    decimation: int
    min_depth: float
    max_depth: float
    voxel_m: float
    floor: float
    ceiling: float


class NodeCloud(msgspec.Struct, frozen=True, eq=False):
    """The points of a node.

    Args:
        xyz: float32 (N, 3), metres in the frame of the robot at the node.
        colors: (N, 3), None if it is of a scan.
        intensities: (N,), None if it has none.
    """

    xyz: F32
    colors: U8 | None = None
    intensities: F32 | None = None

    def __getitem__(self, rows: Any) -> NodeCloud:
        """Return some of the points."""
        colors = None if self.colors is None else self.colors[rows]
        intensities = None if self.intensities is None else self.intensities[rows]
        return NodeCloud(self.xyz[rows], colors, intensities)


def cloud_of(node: Any, settings: CloudSettings) -> NodeCloud | None:
    """Return the points of an rtabmap_msgs/msg/Node, None if it has no data for them.

    Raises:
        ImageError: its data is invalid or unsupported.
    """
    data = node.data
    if settings.from_scan:
        if not len(data.laser_scan_compressed):
            return None
        cloud = _of_scan(data, settings)
    else:
        if not len(data.left_compressed) or not len(data.right_compressed):
            return None
        if len(data.right_camera_info):
            raise ImageError("it has stereo images instead of depths")
        clouds = list(_of_cameras(data, settings))
        cloud = NodeCloud(
            np.concatenate([each.xyz for each in clouds]),
            np.concatenate([each.colors for each in clouds if each.colors is not None]),
        )
    cloud = cloud[is_drawable(cloud.xyz)]
    if settings.voxel_m:
        cloud = cloud[one_per_voxel(cloud.xyz, settings.voxel_m)]
    if settings.floor or settings.ceiling:
        heights = transformed(_pose(node.pose.position, node.pose.orientation), cloud.xyz)[:, 2]
        is_kept = np.ones(len(heights), np.bool_)
        if settings.floor:
            is_kept &= heights >= settings.floor
        if settings.ceiling:
            is_kept &= heights <= settings.ceiling
        cloud = cloud[is_kept]
    return cloud


def _of_cameras(data: Any, settings: CloudSettings) -> Iterator[NodeCloud]:
    """Yield the points of each camera; their images are beside each other."""
    count = len(data.left_camera_info)
    if not count or len(data.local_transform) != count:
        places = len(data.local_transform)
        raise ImageError(f"it has {count} camera infos for {places} transforms of cameras")
    depths, colors = depths_of(data.right_compressed), colors_of(data.left_compressed)
    if colors.ndim == 2:
        colors = np.repeat(colors[..., None], 3, axis=2)
    (rows, columns), (color_rows, color_columns) = depths.shape, colors.shape[:2]
    if columns % count or color_columns % count:
        raise ImageError(f"images of {columns} and {color_columns} columns are of {count} cameras")
    width, step = columns // count, settings.decimation
    # Images of colours may be larger.
    row_of = np.arange(0, rows, step) * color_rows // rows
    column_of = np.arange(0, width, step) * (color_columns // count) // width
    for number, (info, place) in enumerate(
        zip(data.left_camera_info, data.local_transform, strict=True)
    ):
        model = _scaled(CameraModel.of(info, (width, rows)), width, rows)
        z = depths[::step, number * width : (number + 1) * width : step]
        is_kept = (z > 0) & (z >= settings.min_depth) & (z < FARTHEST)
        if settings.max_depth:
            is_kept &= z <= settings.max_depth
        xyz = model.points(np.where(is_kept, z, 0.0), step)[is_kept]
        own = colors[:, number * (color_columns // count) :]
        rgb = own[row_of[:, None], column_of[None]][is_kept]
        pose = _pose(place.translation, place.rotation)
        yield NodeCloud(transformed(pose, xyz).astype(np.float32), rgb)


def _of_scan(data: Any, settings: CloudSettings) -> NodeCloud:
    matrix = matrix_of(data.laser_scan_compressed)
    channels = matrix.shape[1]
    kind = data.laser_scan_format or BY_CHANNELS.get(channels, 0)
    height, intensity = HEIGHTS.get(kind), INTENSITIES.get(kind)
    if CHANNELS.get(kind) != channels:
        raise ImageError(f"its scan has {channels} channels of the format {kind}")
    xyz = np.zeros((len(matrix), 3), np.float32)
    xyz[:, :2] = matrix[:, :2]
    if height is not None:
        xyz[:, 2] = matrix[:, height]
    values = np.zeros(len(matrix), np.float32) if intensity is None else matrix[:, intensity]
    cloud = NodeCloud(xyz, intensities=np.nan_to_num(values))[is_drawable(xyz)]
    ranges = np.linalg.norm(cloud.xyz, axis=1)
    is_kept = ranges >= settings.min_depth
    if settings.max_depth:
        is_kept &= ranges <= settings.max_depth
    place = data.laser_scan_local_transform
    cloud = cloud[is_kept]
    moved = transformed(_pose(place.translation, place.rotation), cloud.xyz)
    return replace(cloud, xyz=moved.astype(np.float32))


def _scaled(model: CameraModel, width: int, height: int) -> CameraModel:
    """Return a camera whose images have another size."""
    x, y = width / model.width, height / model.height
    return replace(
        model,
        width=width,
        height=height,
        fx=model.fx * x,
        fy=model.fy * y,
        cx=model.cx * x,
        cy=model.cy * y,
    )


def _pose(position: Any, rotation: Any) -> Pose:
    """Return the pose of a geometry_msgs Transform or Pose.

    Raises:
        ImageError: it cannot be placed.
    """
    place = np.array([position.x, position.y, position.z])
    turn = [rotation.w, rotation.x, rotation.y, rotation.z]
    (wxyz,), _ = normalized(turn)
    if not is_drawable(place) or not np.isfinite(turn).all():
        raise ImageError("the place of its sensor is invalid")
    return Pose(tuple(place.tolist()), tuple(wxyz.tolist()))
