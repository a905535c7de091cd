"""A robot on rclpy, whatever its middleware: `python rmw_zenoh_robot.py`, until its input ends."""

from __future__ import annotations

import contextlib
import sys
import threading

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from std_srvs.srv import SetBool


def main() -> None:
    """Publish words and a latched one, repeat what is heard, and serve a service."""
    rclpy.init()
    node = rclpy.create_node("robot", namespace="/lab")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "/latched", latched).publish(String(data="map"))
    words = node.create_publisher(String, "/words", 10)
    node.create_timer(0.05, lambda: words.publish(String(data="word")))
    repeated = node.create_publisher(String, "/repeated", 10)
    node.create_subscription(String, "/heard", repeated.publish, 10)
    node.declare_parameter("speed", 0.5)

    def switch(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success, response.message = request.data, "switched"
        return response

    node.create_service(SetBool, "/switch", switch)

    def end() -> None:
        sys.stdin.read()
        rclpy.shutdown()

    threading.Thread(target=end, daemon=True).start()
    with contextlib.suppress(ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
