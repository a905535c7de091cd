"""Messages over real DDS: changed bytes, and extreme values by field."""

from __future__ import annotations

import copy
import struct
import time
from random import Random
from typing import Any

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.context import Context
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.attack.attack import Attack, Case, Outcome, mutated
from tests.support.display_messages import MESSAGES
from webviz.api.display import inputs_of
from webviz.api.registry import display_types
from webviz.data.messages import DecodeError, decode, encode
from webviz.data.messages.typestore import fields
from webviz.ros.types import message_class
from webviz.shell.testing.display_checks import LAST, cases, changed
from webviz.shell.testing.messages import header

DISCOVERY_S = 60.0
TF = "tf2_msgs/msg/TFMessage"
NOW_NS = 1_313_822_273_123_456_789
"""Stands for the time at which a message is sent, so that a seed gives the same attack again."""
FRAMES = ("map", "odom", "base_link", "laser", "no such frame", "")
TRANSFORMS = {
    "transforms": [
        {"child_frame_id": "attacked", "transform": {"rotation": {"w": 1.0}}},
        {"child_frame_id": "attacked/too", "transform": {"translation": {"x": 1e300}}},
    ]
}


def topics() -> dict[str, str]:
    """The types of the topics that the displays subscribe to in their default configuration."""
    result = {"/tf": TF, "/tf_static": TF}
    for class_ in display_types().values():
        display = class_()
        for name, input_ in inputs_of(class_).items():
            topic = getattr(getattr(display, name, None), "name", "")
            if topic and input_.type:
                result[f"/{topic.lstrip('/')}"] = input_.type
    return result


def _stamp(ns: int) -> bytes:
    return struct.pack("<iI", *divmod(ns, 10**9))


class Dds(Attack):
    """Publishes to every topic that is subscribed.

    Args:
        domain: of ROS, in which the viewer is.
    """

    kind = "dds"

    def __init__(self, domain: int) -> None:
        self._domain = domain
        self._context = Context()
        self._publishers: dict[str, Publisher] = {}
        self._types = topics()

    def start(self) -> None:
        rclpy.init(context=self._context, domain_id=self._domain)
        self._node = rclpy.create_node("attacker", context=self._context)
        for topic, type_name in self._types.items():
            qos = QoSProfile(depth=10)
            if topic in ("/tf_static", "/robot_description", "/map"):
                qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
            self._publishers[topic] = self._node.create_publisher(
                message_class(type_name), topic, qos
            )
        self._wait()

    def draw(self, random: Random) -> Case:
        topic = random.choice(sorted(self._types))
        type_name = self._types[topic]
        values: dict[str, Any] = copy.deepcopy(
            TRANSFORMS if type_name == TF else MESSAGES.get(type_name, {})
        )
        # Only now there are transforms, so that the rest is drawn.
        stamp_ns = random.choice((NOW_NS, NOW_NS, 0, 2**60))
        stamped = header(random.choice(FRAMES), stamp_ns)
        if fields(type_name)[0].base == "std_msgs/msg/Header":
            values.setdefault("header", stamped)
        for link in values.get("transforms", ()):
            link["header"] = stamped
        if random.random() < 0.5:
            all_cases = list(cases(type_name, values))
            for case in random.sample(all_cases, min(len(all_cases), random.randint(1, 4))):
                values = changed(values, case)
            cdr = encode(type_name, values).replace(LAST.encode(), b"\xff")
        else:
            cdr = mutated(random, encode(type_name, values))
        return Case(f"{topic[1:].replace('/', '.')}.cdr", cdr)

    def strike(self, case: Case) -> Outcome:
        topic = "/" + case.name.removesuffix(".cdr").replace(".", "/")
        data = case.data.replace(_stamp(NOW_NS), _stamp(time.time_ns()))
        try:
            self._publishers[topic].publish(data)
        except RCLError:  # A reader is so far behind that the middleware sends no more.
            return Outcome.REFUSED
        # As fast as they come they would only replace each other in the queues.
        time.sleep(0.005)
        try:
            decode(self._types[topic], data)
        except DecodeError:
            return Outcome.REFUSED
        return Outcome.SURVIVED

    def close(self) -> None:
        # With the node and its publishers.
        self._context.try_shutdown()

    def _wait(self) -> None:
        deadline = time.monotonic() + DISCOVERY_S
        while missing := [
            topic
            for topic, publisher in self._publishers.items()
            if not publisher.get_subscription_count()
        ]:
            if time.monotonic() > deadline:
                raise TimeoutError(f"the viewer does not subscribe to {', '.join(missing)}")
            time.sleep(0.05)
