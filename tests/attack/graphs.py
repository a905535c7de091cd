"""Graphs of frames: forests, chains, stars and loops of up to ten thousand, and a long name."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from random import Random

import rclpy
from rclpy.context import Context
from rclpy.qos import QoSProfile

from tests.attack.attack import Attack, Case, Outcome, Violation
from tests.attack.target import Target
from webviz.data.messages import encode
from webviz.ros.types import message_class
from webviz.shell.testing.messages import header

TF = "tf2_msgs/msg/TFMessage"
PART = 500
"""Transforms of one message."""
LONG = (0, 0, 100_000)
"""Characters of the name of one more frame, if any."""
LOOPS = ("map x, x map", "p q, q p", "f0 f1, f1 f2, f2 f0", "map f7, f7 map", "")
DISCOVERY_S = 60.0


def links(shape: str, count: int) -> Iterator[tuple[str, str]]:
    """Parents and children."""
    for i in range(count):
        match shape:
            case "star":
                yield "root", f"f{i}"
            case "chain":
                yield f"f{i}", f"f{i + 1}"
            case "pairs":
                yield f"f{i}", f"f{(i + 5000) % 10000}"
            case "ring":
                yield f"f{i}", f"f{(i + 1) % count}"
            case _:
                yield f"f{i // 2}", f"f{i + 1}"


class Graphs(Attack):
    """Publishes transforms that make graphs, and looks whether the viewer still answers.

    Args:
        target: the viewer.
        domain: of ROS, in which the viewer is.
    """

    kind = "graphs"

    def __init__(self, target: Target, domain: int) -> None:
        self._target = target
        self._domain = domain
        self._context = Context()

    def start(self) -> None:
        rclpy.init(context=self._context, domain_id=self._domain)
        node = rclpy.create_node("graph_attacker", context=self._context)
        self._publisher = node.create_publisher(message_class(TF), "/tf", QoSProfile(depth=100))
        deadline = time.monotonic() + DISCOVERY_S
        while not self._publisher.get_subscription_count():
            if time.monotonic() > deadline:
                raise TimeoutError("the viewer does not subscribe to /tf")
            time.sleep(0.05)

    def draw(self, random: Random) -> Case:
        shape = random.choice(("star", "chain", "pairs", "ring", "tree"))
        count = random.choice((10, 100, random.randrange(1000), 10_000))
        return Case(
            f"{shape}.json", json.dumps([count, random.choice(LOOPS), random.choice(LONG)]).encode()
        )

    def strike(self, case: Case) -> Outcome:
        count, loops, characters = json.loads(case.data)
        self._publish([*links(case.name.partition(".")[0], count)])
        pairs = [pair.split() for pair in loops.split(", ") if pair]
        self._publish([(parent, child) for parent, child in pairs])
        if characters:
            self._publish([("map", characters * "n")])
        try:
            self._target.wait_until_answered()
        except Violation as violation:
            raise Violation(f"{violation} [{case.name} {case.data.decode()}]") from violation
        # No loop is left, or nothing else would be drawn.
        self._publish([(f"end {child}", child) for _, child in pairs if child != "map"])
        return Outcome.SURVIVED

    def close(self) -> None:
        self._context.try_shutdown()

    def _publish(self, pairs: list[tuple[str, str]]) -> None:
        for start in range(0, len(pairs), PART):
            stamp_ns = time.time_ns()
            transforms = [
                {
                    "header": header(parent, stamp_ns),
                    "child_frame_id": child,
                    "transform": {"rotation": {"w": 1.0}},
                }
                for parent, child in pairs[start : start + PART]
            ]
            self._publisher.publish(encode(TF, {"transforms": transforms}))
            time.sleep(0.005)
