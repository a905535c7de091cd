"""A viewer as one writes it from viser's documentation and rclpy's tutorials.

    python -m side_by_side.systems.plain TOPIC=TYPE...

A typed subscription for each topic, a callback for each type, a viser node for each thing, a setter
for each value that changes, the executor in a thread. viser's scene tree is the tree of frames, as
its examples have it, so nothing is looked up and nothing waits for a transform.
"""

from __future__ import annotations

import sys
import threading
from typing import Any

import numpy as np
import rclpy
import trimesh
import viser
import yourdfpy
from rclpy.node import Node

from side_by_side.systems.arguments import LATCHED, parsed
from side_by_side.systems.shades import picture, rainbow
from side_by_side.systems.typed import subscribe

TRAIL = 10_000
DELETE = 2


class PlainViewer:
    """Callbacks that keep a viser scene up to date."""

    def __init__(self, server: viser.ViserServer) -> None:
        self.scene = server.scene
        self.parents: dict[str, str] = {}
        self.handles: dict[str, Any] = {}
        self.grids: dict[str, np.ndarray] = {}
        self.trail: list[np.ndarray] = []
        self.info: Any = None

    def path(self, frame: str) -> str:
        """The name of a frame's node: its ancestors, then itself."""
        parent = self.parents.get(frame)
        return f"/{frame}" if parent is None else f"{self.path(parent)}/{frame}"

    def on_transforms(self, topic: str, message: Any) -> None:
        """A node for each frame, moved by its transform."""
        for stamped in message.transforms:
            child, t = stamped.child_frame_id, stamped.transform
            if child not in self.handles:
                self.parents[child] = stamped.header.frame_id
                self.handles[child] = self.scene.add_frame(
                    self.path(child), axes_length=0.2, axes_radius=0.01
                )
            self.handles[child].position = (t.translation.x, t.translation.y, t.translation.z)
            self.handles[child].wxyz = (t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z)

    def on_scan(self, topic: str, message: Any) -> None:
        """Points in the frame of the scanner."""
        ranges = np.array(message.ranges, np.float32)
        angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
        hit = (ranges >= message.range_min) & (ranges <= message.range_max)
        x, y = ranges * np.cos(angles), ranges * np.sin(angles)
        points = np.stack([x, y, np.zeros_like(x)], axis=-1)[hit].astype(np.float32)
        intensities = np.array(message.intensities, np.float32)[hit]
        self.set_points(topic, message.header.frame_id, points, rainbow(intensities))

    def on_cloud(self, topic: str, message: Any) -> None:
        """Points in the frame of the sensor."""
        data = np.frombuffer(message.data, np.float32).reshape(-1, message.point_step // 4)
        points = data[np.isfinite(data).all(axis=1)]
        self.set_points(topic, message.header.frame_id, points[:, :3], rainbow(points[:, 3]))

    def set_points(self, topic: str, frame: str, points: np.ndarray, colors: np.ndarray) -> None:
        """Make a cloud, or change the one there is."""
        if topic not in self.handles:
            self.handles[topic] = self.scene.add_point_cloud(
                f"{self.path(frame)}{topic}", points, colors, precision="float32"
            )
        self.handles[topic].points = points
        self.handles[topic].colors = colors

    def on_map(self, topic: str, message: Any) -> None:
        """A picture, one pixel for each cell."""
        info = message.info
        self.grids[topic] = np.array(message.data, np.int8).reshape(info.height, info.width)
        if topic not in self.handles:
            width, height = info.width * info.resolution, info.height * info.resolution
            middle = (width / 2, height / 2, 0.0)
            self.handles[topic] = self.scene.add_image(
                f"{self.path(message.header.frame_id)}{topic}",
                picture(self.grids[topic]),
                width,
                height,
                position=middle,
            )
        else:
            self.handles[topic].image = picture(self.grids[topic])

    def on_map_update(self, topic: str, message: Any) -> None:
        """A rectangle of a map's cells."""
        whole = topic.removesuffix("_updates")
        if whole in self.grids:
            rows = slice(message.y, message.y + message.height)
            columns = slice(message.x, message.x + message.width)
            cells = np.array(message.data, np.int8).reshape(message.height, message.width)
            self.grids[whole][rows, columns] = cells
            self.handles[whole].image = picture(self.grids[whole])

    def on_path(self, topic: str, message: Any) -> None:
        """A line."""
        positions = [pose.pose.position for pose in message.poses]
        points = np.array([(p.x, p.y, p.z) for p in positions], np.float32)
        segments = np.stack([points[:-1], points[1:]], axis=1)
        if topic not in self.handles:
            name = f"{self.path(message.header.frame_id)}{topic}"
            self.handles[topic] = self.scene.add_line_segments(name, segments, (25, 255, 0))
        self.handles[topic].points = segments

    def on_odometry(self, topic: str, message: Any) -> None:
        """An arrow for each of the last poses."""
        p, q = message.pose.pose.position, message.pose.pose.orientation
        yaw = 2 * np.arctan2(q.z, q.w)
        end = (p.x + np.cos(yaw), p.y + np.sin(yaw), p.z)
        self.trail.append(np.array([(p.x, p.y, p.z), end]))
        del self.trail[:-TRAIL]
        arrows = np.array(self.trail, np.float32)
        if topic not in self.handles:
            name = f"{self.path(message.header.frame_id)}{topic}"
            self.handles[topic] = self.scene.add_arrows(name, arrows, (255, 25, 0))
        self.handles[topic].points = arrows

    def on_markers(self, topic: str, message: Any) -> None:
        """A box for each marker."""
        for marker in message.markers:
            name, p = (
                f"{self.path(marker.header.frame_id)}{topic}/{marker.id}",
                marker.pose.position,
            )
            node = self.handles.get(name)
            if marker.action == DELETE:
                if node is not None:
                    self.handles.pop(name).remove()
                continue
            if node is None:
                size, color = marker.scale, (marker.color.r, marker.color.g, marker.color.b)
                node = self.scene.add_box(name, color, (size.x, size.y, size.z))
                self.handles[name] = node
            node.position = (p.x, p.y, p.z)

    def on_image(self, topic: str, message: Any) -> None:
        """Depths as points."""
        if self.info is not None:
            points, colors = depth_points(message, self.info)
            self.set_points(topic, message.header.frame_id, points, colors)

    def on_info(self, topic: str, message: Any) -> None:
        """Needed for depths."""
        self.info = message

    def on_description(self, topic: str, message: Any) -> None:
        """A mesh for each box, cylinder and sphere of a robot, below the frame of its link."""
        robot = yourdfpy.URDF.load(
            trimesh.util.wrap_as_stream(message.data), load_meshes=False, build_scene_graph=False
        )
        for name, link in robot.link_map.items():
            for i, visual in enumerate(link.visuals):
                if mesh := solid(visual.geometry):
                    mesh.apply_transform(np.eye(4) if visual.origin is None else visual.origin)
                    self.scene.add_mesh_trimesh(f"/{name}/visual_{i}", mesh)


def depth_points(depth: Any, info: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) of depths in mm, coloured by their depth: uint8 (N, 3)."""
    z = np.frombuffer(depth.data, np.uint16).reshape(depth.height, depth.width) / 1000
    columns, rows = np.meshgrid(np.arange(depth.width), np.arange(depth.height))
    x = (columns - info.p[2]) * z / info.p[0]
    y = (rows - info.p[6]) * z / info.p[5]
    points = np.stack([x, y, z], axis=-1)[z > 0].astype(np.float32)
    return points, rainbow(points[:, 2])


def solid(geometry: yourdfpy.Geometry) -> trimesh.Trimesh | None:
    """The mesh of a simple shape, None for another."""
    if geometry.box is not None:
        return trimesh.creation.box(geometry.box.size)
    if geometry.cylinder is not None:
        return trimesh.creation.cylinder(geometry.cylinder.radius, geometry.cylinder.length)
    if geometry.sphere is not None:
        return trimesh.creation.icosphere(radius=geometry.sphere.radius)
    return None


def main(*topics: str) -> None:
    """Run until it is ended."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    viewer = PlainViewer(server)
    callbacks = {
        "tf2_msgs/msg/TFMessage": viewer.on_transforms,
        "sensor_msgs/msg/LaserScan": viewer.on_scan,
        "sensor_msgs/msg/PointCloud2": viewer.on_cloud,
        "nav_msgs/msg/OccupancyGrid": viewer.on_map,
        "map_msgs/msg/OccupancyGridUpdate": viewer.on_map_update,
        "nav_msgs/msg/Path": viewer.on_path,
        "nav_msgs/msg/Odometry": viewer.on_odometry,
        "visualization_msgs/msg/MarkerArray": viewer.on_markers,
        "sensor_msgs/msg/Image": viewer.on_image,
        "sensor_msgs/msg/CameraInfo": viewer.on_info,
        "std_msgs/msg/String": viewer.on_description,
    }
    rclpy.init()
    node = Node("plain_viewer")
    for topic, kind in parsed(topics).items():
        subscribe(node, topic, kind, callbacks[kind], LATCHED.get(topic, 10))
    spinning = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinning.start()
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    spinning.join()


if __name__ == "__main__":
    main(*sys.argv[1:])
