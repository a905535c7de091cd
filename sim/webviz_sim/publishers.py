"""Publishers of the simulated robot, over DDS or Zenoh."""

from typing import Any, Protocol


class SimPublisher(Protocol):
    """A publisher of serialised messages."""

    def publish(self, cdr: bytes) -> object:
        """Publish a message with its encapsulation header."""
        ...


class SimPublishers(Protocol):
    """Creates publishers."""

    def publisher(
        self, type: str, topic: str, depth: int = 10, durability: str = "volatile"
    ) -> SimPublisher:
        """Create a publisher.

        Args:
            type: Such as "nav_msgs/msg/Odometry".
            topic: Its name; with a slash before it, outside the namespace of the robot.
            depth: Messages that are kept; 0 for best effort.
            durability: Or "transient_local", for those who subscribe later.
        """
        ...


class RosPublishers:
    """Creates publishers of a ROS node.

    Args:
        node: Publishes.
    """

    def __init__(self, node: Any) -> None:
        self._node = node

    def publisher(
        self, type: str, topic: str, depth: int = 10, durability: str = "volatile"
    ) -> SimPublisher:
        """See `SimPublishers.publisher`."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data

        from webviz.ros.types import message_class

        qos = qos_profile_sensor_data
        if depth:
            qos = QoSProfile(depth=depth, durability=DurabilityPolicy[durability.upper()])
        return self._node.create_publisher(message_class(type), topic, qos)
