"""The messages of the scenes, as nested mappings with gaps for stamps and marks."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from clouds import XYZ

from side_by_side import strip
from side_by_side.marks import FRAME_Z, LINK_Z, PER_METRE, Lane, Place
from side_by_side.streams import NO_MARK, Stream, header

VARIANTS = 8
DEPTHS = 32
"""Images of depths, each with its mark."""
FOCAL = 500.0
Values = dict[str, Any]


def scans(frame: str, beams: int) -> list[Values]:
    """Laser scans of a room that shimmers; the first beam looks along x and is marked."""
    rng = np.random.default_rng(1)
    step = math.tau / beams
    walls = 4 + np.abs(np.sin(np.arange(beams) * step * 2))
    messages = []
    for _ in range(VARIANTS):
        ranges = (walls + rng.normal(0, 0.02, beams)).astype(np.float32)
        ranges[0] = NO_MARK
        messages.append(
            {
                "header": header(frame),
                "angle_min": 0.0,
                "angle_max": step * (beams - 1),
                "angle_increment": step,
                "range_min": 0.1,
                "range_max": 1e4,
                "ranges": ranges,
                "intensities": rng.uniform(0, 100, beams).astype(np.float32),
            }
        )
    return messages


def clouds(frame: str, count: int, variants: int = 2) -> list[Values]:
    """Clouds of x, y, z and intensity; the first points are marked, so that
    the first of a decimated cloud is: one of 50 if it has 100 000 of 5
    million."""
    rng = np.random.default_rng(2)
    names = ("name", "offset", "datatype", "count")
    fields = [dict(zip(names, field, strict=True)) for field in [*XYZ, ("intensity", 12, 7, 1)]]
    messages = []
    for _ in range(variants):
        points = rng.normal(0, 20, (count, 4)).astype(np.float32)
        points[:100] = (NO_MARK, 0, 0, 1)
        points[:, 3] = np.abs(points[:, 3])
        messages.append(
            {
                "header": header(frame),
                "height": 1,
                "width": count,
                "fields": fields,
                "point_step": 16,
                "row_step": 16 * count,
                "data": points.view(np.uint8).reshape(-1),
                "is_dense": True,
            }
        )
    return messages


def frames(prefix: str, root: str, count: int, branching: int = 6) -> list[Values]:
    """A tree of frames that all sway; the first is marked and has no children."""
    rng = np.random.default_rng(3)
    places = rng.uniform(-5, 5, (count, 3))
    messages = []
    for variant in range(VARIANTS):
        angle = 0.05 * math.sin(math.tau * variant / VARIANTS)
        moved = [_transform(root, f"{prefix}mark", (NO_MARK, 0, FRAME_Z), angle)]
        for i in range(1, count):
            parent = root if i <= branching else f"{prefix}{(i - 1) // branching}"
            moved.append(_transform(parent, f"{prefix}{i}", np.abs(places[i]), angle + 0.001 * i))
        messages.append({"transforms": moved})
    return messages


def passing_frames(groups: int, repeats: int, count: int = 8) -> list[Values]:
    """Groups of frames that are published in turn, each some times, so that they come and go."""
    return [
        {
            "transforms": [
                _transform("map", f"passing_{group}_{i}", (group, i, 0.1 * repeat), 0)
                for i in range(count)
            ]
        }
        for group in range(groups)
        for repeat in range(repeats)
    ]


def links(count: int) -> list[Values]:
    """Transforms of the robot of `robot`; its base is marked."""
    messages = []
    for variant in range(VARIANTS):
        angle = 0.3 * math.sin(math.tau * variant / VARIANTS)
        moved = [_transform("map", "link_0", (NO_MARK, 0, LINK_Z), 0)]
        moved += [
            _transform(f"link_{(i - 1) // 3}", f"link_{i}", (0.3, 0.1 * (i % 3), 0.2), angle)
            for i in range(1, count)
        ]
        messages.append({"transforms": moved})
    return messages


def robot(count: int) -> list[Values]:
    """The description of a robot of boxes, each link with its joint to every third one before."""
    parts = ["<robot name='bench'>"]
    for i in range(count):
        parts.append(
            f"<link name='link_{i}'><visual><geometry><box size='0.3 0.1 0.1'/></geometry>"
            f"<material name='m{i}'><color rgba='{i / count:.2f} 0.5 0.3 1'/></material>"
            "</visual></link>"
        )
    for i in range(1, count):
        parts.append(
            f"<joint name='joint_{i}' type='continuous'><parent link='link_{(i - 1) // 3}'/>"
            f"<child link='link_{i}'/><axis xyz='0 0 1'/></joint>"
        )
    return [{"data": "".join([*parts, "</robot>"])}]


def static(*pairs: tuple[str, str]) -> list[Values]:
    """Frames that stand half a metre above their parents."""
    return [{"transforms": [_transform(parent, child, (0, 0, 0.5), 0) for parent, child in pairs]}]


def moving(parent: str, child: str) -> list[Values]:
    """A frame that drives to and fro along y, which leaves marks in x as they are."""
    angles = np.linspace(0, math.tau, 500, endpoint=False)
    return [{"transforms": [_transform(parent, child, (0, math.sin(a), 0), 0)]} for a in angles]


def maps(size: int, variants: int = 1) -> list[Values]:
    """Square maps of free, occupied and unknown blobs, with a strip in the midst."""
    rng = np.random.default_rng(4)
    messages = []
    for _ in range(variants):
        coarse = rng.choice([0, 0, 0, 100, -1], (size // 20, size // 20))
        grid = np.kron(coarse, np.ones((20, 20))).astype(np.int8)
        middle = size // 8 * 4
        grid[middle : middle + strip.BLOCK, middle : middle + strip.LENGTH * strip.BLOCK] = 77
        info = {
            "resolution": 0.05,
            "width": size,
            "height": size,
            "origin": {"orientation": {"w": 1.0}},
        }
        messages.append({"header": header("map"), "info": info, "data": grid.reshape(-1)})
    return messages


def map_updates(size: int, edge: int) -> list[Values]:
    """Squares of a map that come anew, each somewhere else; all with a strip.

    None reaches over a multiple of 256 cells, where a viewer that sends tiles might cut its strip.
    """
    rng = np.random.default_rng(5)
    messages = []
    for _ in range(VARIANTS):
        corner = rng.integers(0, size // 256, 2) * 256 + rng.integers(0, (256 - edge) // 8, 2) * 8
        x, y = corner.tolist()
        grid = rng.choice([0, 100, -1], (edge, edge)).astype(np.int8)
        grid[: strip.BLOCK, : strip.LENGTH * strip.BLOCK] = 77
        messages.append(
            {
                "header": header("map"),
                "x": x,
                "y": y,
                "width": edge,
                "height": edge,
                "data": grid.reshape(-1),
            }
        )
    return messages


def paths(count: int) -> list[Values]:
    """Lines over ground; the first pose is marked."""
    messages = []
    for variant in range(VARIANTS):
        along = np.arange(count) * 0.05
        across = np.sin(along + variant / VARIANTS)
        rows = [(NO_MARK, 0.0), *zip(along[1:].tolist(), across[1:].tolist(), strict=True)]
        poses = [
            {
                "header": header("map"),
                "pose": {"position": {"x": x, "y": y}, "orientation": {"w": 1.0}},
            }
            for x, y in rows
        ]
        messages.append({"header": header("map"), "poses": poses})
    return messages


def odometry() -> list[Values]:
    """A drive round and round, 12 cm a message, always at a new height, which is the mark."""
    messages = []
    for angle in np.linspace(0, math.tau, 500, endpoint=False):
        position = {"x": 10 * math.cos(angle), "y": 10 * math.sin(angle), "z": NO_MARK}
        pose = {"position": position, "orientation": _yaw(angle)}
        messages.append(
            {
                "header": header("map"),
                "child_frame_id": "base_link",
                "pose": {"pose": pose, "covariance": np.eye(6).reshape(-1) * 0.01},
                "twist": {"covariance": np.zeros(36)},
            }
        )
    return messages


def depths(width: int, height: int) -> list[Stream]:
    """Depths of 16UC1 at 30 Hz; x of the point of the first pixel is the mark.

    Hence the principal point, left of the image: x is depth in mm by `PER_METRE`.
    """
    rng = np.random.default_rng(7)
    rows, columns = np.mgrid[:height, :width]
    walls = 2000 + 1000 * np.sin(columns / 90) + 500 * np.cos(rows / 70)
    left = -FOCAL * 1000 / PER_METRE
    lane = Lane(0, Place.FIRST_POINT, DEPTHS)
    messages = []
    for variant in range(DEPTHS):
        millimetres = (walls + rng.normal(0, 5, walls.shape)).astype(np.uint16)
        millimetres[0, 0] = round(lane.encode(variant) * PER_METRE)
        messages.append(
            {
                "header": header("optical"),
                "height": height,
                "width": width,
                "encoding": "16UC1",
                "step": 2 * width,
                "data": millimetres.reshape(-1).view(np.uint8),
            }
        )
    info = {
        "header": header("optical"),
        "width": width,
        "height": height,
        "distortion_model": "plumb_bob",
        "d": np.zeros(5),
        "k": np.array([FOCAL, 0, left, 0, FOCAL, height / 2, 0, 0, 1]),
        "r": np.eye(3).reshape(-1),
        "p": np.array([FOCAL, 0, left, 0, 0, FOCAL, height / 2, 0, 0, 0, 1, 0]),
    }
    return [
        Stream("/tf_static", "tf2_msgs/msg/TFMessage", 0, static(("map", "optical"))),
        Stream("/depth/camera_info", "sensor_msgs/msg/CameraInfo", 30, [info]),
        Stream("/depth/image", "sensor_msgs/msg/Image", 30, messages, lane),
    ]


def _yaw(angle: float) -> Values:
    return {"z": math.sin(angle / 2), "w": math.cos(angle / 2)}


def _transform(parent: str, child: str, xyz: Any, yaw: float) -> Values:
    x, y, z = (float(value) for value in xyz)
    transform = {"translation": {"x": x, "y": y, "z": z}, "rotation": _yaw(yaw)}
    return {"header": header(parent), "child_frame_id": child, "transform": transform}
