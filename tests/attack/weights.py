"""Messages that are large, or that become large once they are decoded."""

from __future__ import annotations

import json
import time
from random import Random
from typing import Any

import numpy as np
from rclpy._rclpy_pybind11 import RCLError

from tests.attack.attack import Case, Outcome
from tests.attack.dds import Dds
from tests.attack.target import Target
from webviz.data.messages import encode
from webviz.shell.testing.messages import header

ENCODINGS = {"rgb8": 3, "mono16": 2, "32FC1": 4, "bayer_rggb16": 2, "yuv422": 2}
"""Encodings of images, and the bytes of a pixel."""
EDGES = (100, 500, 1000, 2000)
"""Edges of images in pixels."""
LEVELS = 7
"""Number of levels of octrees, in which each node has eight children: two million nodes."""
MESH = {
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
}
"""A glTF file without its accessor, which claims more vertices than there are bytes."""


class Weights(Dds):
    """Publishes images, octrees and meshes, several at once.

    Args:
        target: the viewer.
        domain: of ROS, in which the viewer is.
    """

    kind = "weights"

    def __init__(self, target: Target, domain: int) -> None:
        super().__init__(domain)
        self._target = target

    def draw(self, random: Random) -> Case:
        topics = sorted(topic for topic, type_ in self._types.items() if type_ in MAKERS)
        chosen = random.sample(topics, random.randint(1, min(4, len(topics))))
        return Case("weights.json", json.dumps([chosen, random.getrandbits(32)]).encode())

    def strike(self, case: Case) -> Outcome:
        topics, seed = json.loads(case.data)
        for topic in topics:
            random = Random(f"{seed} {topic}")
            values = MAKERS[self._types[topic]](random)
            values["header"] = header("map", time.time_ns())
            if self._types[topic] == MARKERS:
                values = {"markers": [values]}
            try:
                self._publishers[topic].publish(encode(self._types[topic], values))
            except RCLError:  # A reader is so far behind that the middleware sends no more.
                return Outcome.REFUSED
        self._target.wait_until_answered()
        return Outcome.SURVIVED


def _image(random: Random) -> dict[str, Any]:
    encoding, edge = random.choice(list(ENCODINGS)), random.choice(EDGES)
    step = edge * ENCODINGS[encoding]
    data = np.zeros(step * edge, np.uint8)
    return {"width": edge, "height": edge, "encoding": encoding, "step": step, "data": data}


def _octree(random: Random) -> dict[str, Any]:
    levels = random.randint(1, LEVELS)
    record = np.array([(3.0, 0)], [("log_odds", "<f4"), ("children", "u1")])
    inner = np.array([(3.0, 255)], record.dtype)
    for _ in range(levels):
        record = np.concatenate((inner, np.tile(record, 8)))
    return {"id": "OcTree", "resolution": 0.05, "data": record.view(np.int8)}


def _marker(random: Random) -> dict[str, Any]:
    count = random.choice((1 << 10, 1 << 20, 1 << 24, 1 << 30))
    accessors = [{"componentType": 5126, "count": count, "type": "VEC3"}]
    name = f"{random.getrandbits(32)}.gltf"
    file = json.dumps({**MESH, "accessors": accessors}).encode()
    one = {"x": 1.0, "y": 1.0, "z": 1.0}
    return {
        "id": random.randrange(20),
        "type": 10,
        "scale": one,
        "color": {"a": 1.0},
        "mesh_resource": f"embedded://{name}",
        "mesh_file": {"filename": name, "data": np.frombuffer(file, np.uint8)},
    }


MARKERS = "visualization_msgs/msg/MarkerArray"
MAKERS = {
    "sensor_msgs/msg/Image": _image,
    "octomap_msgs/msg/Octomap": _octree,
    MARKERS: _marker,
}
"""Makes a message of each type, without its header."""
