"""A logger with rerun-sdk: typed messages to archetypes, served over gRPC to any Rerun viewer.

    python -m side_by_side.systems.rerun TOPIC=TYPE...

As Rerun's ROS example has it: a subscription for each topic, `rr.log` in its callback, entities in
a tree of frames. Rerun keeps what was logged, up to the memory limit of its server (1 GiB unless
told otherwise), so that a viewer can go back in time; that is what it is for.
"""

from __future__ import annotations

import sys
import threading
from typing import Any

import numpy as np
import rclpy
import rerun as rr  # pyright: ignore[reportMissingImports]
from rclpy.node import Node

from side_by_side.rerun_wire import timeline_value
from side_by_side.systems.arguments import LATCHED, parsed
from side_by_side.systems.ports import free_port
from side_by_side.systems.shades import picture, rainbow
from side_by_side.systems.typed import subscribe

TRAIL = 10_000
LINE_LIST, TEXT, DELETE = 5, 9, 2


class Logger:
    """Callbacks that log messages."""

    def __init__(self) -> None:
        self.parents: dict[str, str] = {}
        self.grids: dict[str, np.ndarray] = {}
        self.trail: list[np.ndarray] = []
        self.markers: dict[int, Any] = {}

    def path(self, frame: str) -> str:
        """The entity of a frame: below its ancestors."""
        parent = self.parents.get(frame)
        return frame if parent is None else f"{self.path(parent)}/{frame}"

    def on_transforms(self, topic: str, message: Any) -> None:
        """An entity for each frame."""
        for stamped in message.transforms:
            at(stamped.header)
            self.parents[stamped.child_frame_id] = stamped.header.frame_id
            t, q = stamped.transform.translation, stamped.transform.rotation
            rr.log(
                self.path(stamped.child_frame_id),
                rr.Transform3D(
                    translation=(t.x, t.y, t.z), quaternion=rr.Quaternion(xyzw=(q.x, q.y, q.z, q.w))
                ),
            )

    def on_scan(self, topic: str, message: Any) -> None:
        """Points."""
        ranges = np.array(message.ranges, np.float32)
        angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
        hit = (ranges >= message.range_min) & (ranges <= message.range_max)
        points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles), 0 * angles], axis=-1)
        self.log_points(topic, message.header, points[hit], np.array(message.intensities)[hit])

    def on_cloud(self, topic: str, message: Any) -> None:
        """Points."""
        data = np.frombuffer(message.data, np.float32).reshape(-1, message.point_step // 4)
        self.log_points(topic, message.header, data[:, :3], data[:, 3])

    def log_points(
        self, topic: str, header: Any, points: np.ndarray, intensities: np.ndarray
    ) -> None:
        """Points in the frame of a header."""
        at(header)
        rr.log(
            f"{self.path(header.frame_id)}{topic}",
            rr.Points3D(points.astype(np.float32), colors=rainbow(intensities)),
        )

    def on_map(self, topic: str, message: Any) -> None:
        """A picture."""
        at(message.header)
        info = message.info
        self.grids[topic] = np.array(message.data, np.int8).reshape(info.height, info.width)
        rr.log(f"{self.path(message.header.frame_id)}{topic}", rr.Image(picture(self.grids[topic])))

    def on_map_update(self, topic: str, message: Any) -> None:
        """The whole picture again."""
        whole = topic.removesuffix("_updates")
        if whole in self.grids:
            at(message.header)
            rows = slice(message.y, message.y + message.height)
            columns = slice(message.x, message.x + message.width)
            cells = np.array(message.data, np.int8).reshape(message.height, message.width)
            self.grids[whole][rows, columns] = cells
            rr.log(
                f"{self.path(message.header.frame_id)}{whole}",
                rr.Image(picture(self.grids[whole])),
            )

    def on_path(self, topic: str, message: Any) -> None:
        """A line."""
        at(message.header)
        positions = [pose.pose.position for pose in message.poses]
        line = np.array([(p.x, p.y, p.z) for p in positions], np.float32)
        rr.log(f"{self.path(message.header.frame_id)}{topic}", rr.LineStrips3D([line]))

    def on_odometry(self, topic: str, message: Any) -> None:
        """Arrows of the last poses."""
        at(message.header)
        p, q = message.pose.pose.position, message.pose.pose.orientation
        yaw = 2 * np.arctan2(q.z, q.w)
        self.trail.append(np.array((p.x, p.y, p.z, np.cos(yaw), np.sin(yaw), 0), np.float32))
        del self.trail[:-TRAIL]
        arrows = np.array(self.trail)
        rr.log(
            f"{self.path(message.header.frame_id)}{topic}",
            rr.Arrows3D(origins=arrows[:, :3], vectors=arrows[:, 3:]),
        )

    def on_markers(self, topic: str, message: Any) -> None:
        """The boxes, lines and texts of all markers, each kind as one entity."""
        at(message.markers[0].header)
        path = f"{self.path(message.markers[0].header.frame_id)}{topic}"
        for marker in message.markers:
            self.markers.pop(marker.id, None)
            if marker.action != DELETE:
                self.markers[marker.id] = marker
        for kind in {marker.type for marker in message.markers}:
            some = [marker for marker in self.markers.values() if marker.type == kind]
            places = [(p.x, p.y, p.z) for p in (marker.pose.position for marker in some)]
            colors = [(c.r, c.g, c.b, c.a) for c in (marker.color for marker in some)]
            if kind == LINE_LIST:
                ends = [(p.x, p.y, p.z) for marker in some for p in marker.points]
                strips = np.array(ends, np.float32).reshape(-1, 2, 3)
                rr.log(f"{path}/lines", rr.LineStrips3D(strips, colors=colors[:1]))
            elif kind == TEXT:
                words = [marker.text for marker in some]
                rr.log(f"{path}/texts", rr.Points3D(places, labels=words, colors=colors))
            else:
                halves = [(s.x / 2, s.y / 2, s.z / 2) for s in (marker.scale for marker in some)]
                boxes = rr.Boxes3D(centers=places, half_sizes=halves, colors=colors)
                rr.log(f"{path}/boxes", boxes)

    def on_description(self, topic: str, message: Any) -> None:
        """The text; Rerun loads robots from files."""
        rr.log(topic, rr.TextDocument(message.data), static=True)


def at(header: Any) -> None:
    """Log what follows at the stamp of a header."""
    stamp_ns = header.stamp.sec * 1_000_000_000 + header.stamp.nanosec
    rr.set_time("ros", timestamp=np.datetime64(stamp_ns, "ns"))
    rr.set_time("publication", sequence=timeline_value(stamp_ns))


def main(*topics: str) -> None:
    """Run until it is ended."""
    rr.init("side_by_side")
    port = free_port()
    rr.serve_grpc(grpc_port=port)
    logger = Logger()
    callbacks = {
        "tf2_msgs/msg/TFMessage": logger.on_transforms,
        "sensor_msgs/msg/LaserScan": logger.on_scan,
        "sensor_msgs/msg/PointCloud2": logger.on_cloud,
        "nav_msgs/msg/OccupancyGrid": logger.on_map,
        "map_msgs/msg/OccupancyGridUpdate": logger.on_map_update,
        "nav_msgs/msg/Path": logger.on_path,
        "nav_msgs/msg/Odometry": logger.on_odometry,
        "visualization_msgs/msg/MarkerArray": logger.on_markers,
        "std_msgs/msg/String": logger.on_description,
    }
    rclpy.init()
    node = Node("rerun_logger")
    for topic, kind in parsed(topics).items():
        subscribe(node, topic, kind, callbacks[kind], LATCHED.get(topic, 10))
    spinning = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinning.start()
    print(f"http://127.0.0.1:{port}", flush=True)
    spinning.join()


if __name__ == "__main__":
    main(*sys.argv[1:])
