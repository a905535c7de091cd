"""An interactive marker server on ROS, with the rules of the package interactive_markers."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from geometry_msgs.msg import Pose
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerFeedback,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
)
from visualization_msgs.srv import GetInteractiveMarkers

from webviz.data.messages import encode
from webviz.ros.types import message_class

Feedback = InteractiveMarkerFeedback
TRANSFORMS = "tf2_msgs/msg/TFMessage"
QUEUE = 100
"""Depth of the queue of feedback; that of the package is 1, of which a busy machine would lose
some."""
OTHERS_S = 1.0
"""Time in seconds for which the server listens to the last client of a marker alone."""


class MarkerServer:
    """Serves markers under a namespace, in a thread of its own.

    Args:
        namespace: such as "/basic_controls".
        domain: ROS domain.
        markers: at first.
    """

    def __init__(self, namespace: str, domain: int, markers: Sequence[InteractiveMarker]) -> None:
        self.feedback: list[Feedback] = []
        """Feedback received, oldest first, from all clients listened to."""
        self.requests = 0
        """Number of requests for all markers."""
        self.callback: Callable[[Feedback], object] = lambda feedback: None
        """Called with each feedback, before changes are applied."""
        self.markers = {marker.name: marker for marker in markers}
        self.sequence = 0
        self._changed: dict[str, InteractiveMarker] = {}
        self._poses: dict[str, InteractiveMarkerPose] = {}
        self._erased: list[str] = []
        self._clients: dict[str, tuple[str, float]] = {}
        self._lock = threading.RLock()
        self._context = Context()
        rclpy.init(
            context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
        )
        node = self._node = Node("marker_server", context=self._context)
        name = f"{namespace}/get_interactive_markers"
        node.create_service(GetInteractiveMarkers, name, self._answer)
        self._updates = node.create_publisher(InteractiveMarkerUpdate, f"{namespace}/update", 100)
        node.create_subscription(Feedback, f"{namespace}/feedback", self._hear, QUEUE)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._static = node.create_publisher(message_class(TRANSFORMS), "/tf_static", latched)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def transform(self, parent: str, child: str, x: float, y: float, z: float) -> None:
        """Publish a static transform, in place of the one before."""
        each = {
            "header": {"frame_id": parent},
            "child_frame_id": child,
            "transform": {"translation": {"x": x, "y": y, "z": z}},
        }
        self._static.publish(encode(TRANSFORMS, {"transforms": [each]}))

    def insert(self, marker: InteractiveMarker) -> None:
        """Add or replace a marker with the next changes."""
        with self._lock:
            self._changed[marker.name] = self.markers[marker.name] = marker

    def set_pose(self, name: str, pose: Pose) -> None:
        """Move a marker with the next changes."""
        with self._lock:
            self.markers[name].pose = pose
            header = self.markers[name].header
            self._poses[name] = InteractiveMarkerPose(header=header, pose=pose, name=name)

    def erase(self, name: str) -> None:
        """Remove a marker with the next changes."""
        with self._lock:
            del self.markers[name]
            self._erased.append(name)

    def apply(self, *, dropped: bool = False) -> None:
        """Send the changes as an update; a dropped one is counted but not sent."""
        with self._lock:
            if not (self._changed or self._poses or self._erased):
                return
            self.sequence += 1
            update = InteractiveMarkerUpdate(
                seq_num=self.sequence,
                type=InteractiveMarkerUpdate.UPDATE,
                markers=list(self._changed.values()),
                poses=[p for name, p in self._poses.items() if name not in self._changed],
                erases=self._erased,
            )
            self._changed, self._poses, self._erased = {}, {}, []
            if not dropped:
                self._updates.publish(update)

    def send(self, update: InteractiveMarkerUpdate | bytes) -> None:
        """Send any update, also a serialised one, as a faulty server might."""
        self._updates.publish(update)

    def close(self) -> None:
        """End it."""
        self._context.try_shutdown()
        self._thread.join()
        self._node.destroy_node()

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()

    def _answer(self, request: Any, response: Any) -> Any:
        with self._lock:
            self.requests += 1
            response.sequence_number = self.sequence
            response.markers = list(self.markers.values())
        return response

    def _hear(self, feedback: Feedback) -> None:
        with self._lock:
            name, now = feedback.marker_name, time.monotonic()
            if (marker := self.markers.get(name)) is None:
                return
            client, heard_s = self._clients.get(name, ("", -OTHERS_S))
            if client != feedback.client_id and now - heard_s < OTHERS_S:
                return
            self._clients[name] = feedback.client_id, now
            self.feedback.append(feedback)
            if feedback.event_type == Feedback.POSE_UPDATE:
                if marker.header.stamp.sec or marker.header.stamp.nanosec:
                    marker.header = feedback.header
                self.set_pose(name, feedback.pose)
            self.callback(feedback)
            self.apply()
