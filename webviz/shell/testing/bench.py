"""A display at work without ROS and browser: messages in, nodes and statuses out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.display import Display, inputs
from webviz.api.frames import Frames
from webviz.api.nodes import Points, Pose
from webviz.api.picking import Details
from webviz.api.status import OtherFixedFrame, Remedy, Status
from webviz.data.messages import encode, interfaces
from webviz.data.rotations import matrices
from webviz.data.transforms import TransformBuffer
from webviz.engine.commands import NodePicks
from webviz.engine.pipeline import DisplayServices, Runner
from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.details import details_tree
from webviz.engine.pipeline.point_budget import PointBudget
from webviz.shell.testing.messages import header
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import SECOND, HandFedSource
from webviz.sources import Offer, Publisher, Raw, RestrictedGraph, Rights

PATIENCE_S = 60.0
START = 100 * SECOND
"""ROS time in ns at which every bench begins."""

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class DisplayBench:
    """One display, its transforms and its scene.

    Args:
        display: any display; what it raises is raised.
        workers: do its slow work.
        fixed_frame: frame id that everything is drawn in.
    """

    def __init__(self, display: Display, workers: Workers, fixed_frame: str = "map") -> None:
        self.display = display
        self.fixed_frame = fixed_frame
        self.buffer = TransformBuffer()
        self.scene = RecordingScene()
        self.now_ns = START
        self.graph = RememberingGraph()
        restricted_graph = RestrictedGraph(
            HandFedSource(graph=self.graph), Rights(), lambda: ("/*",)
        )
        services = DisplayServices(
            self.scene,
            workers,
            lambda topic: topic,
            strict=True,
            graph=restricted_graph,
            points=PointBudget(self.scene.points_held),
        )
        self.runner = Runner("display", display, services)
        self.offers: dict[str, Offer] = {}
        """Topics that the display finds, as a source has them."""
        self._batches: dict[str, list[Raw]] = {}

    def transform(
        self,
        parent: str,
        child: str,
        xyz: Vector = (0.0, 0.0, 0.0),
        xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0),
        *,
        stamp_ns: int | None = None,
    ) -> None:
        """Publish a transform: static, unless it has a stamp."""
        self.buffer.set_transform(parent, child, stamp_ns or 0, xyz, xyzw, stamp_ns is None)

    def send(
        self,
        type_name: str,
        values: Mapping[str, Any],
        *,
        frame: str | None = None,
        stamp_ns: int | None = None,
        topic: str = "",
    ) -> None:
        """Publish a message as real CDR bytes.

        Args:
            type_name: such as "sensor_msgs/msg/LaserScan".
            values: nested mappings; fields left out are zero or empty.
            frame: frame id of its header; None leaves the header to `values`.
            stamp_ns: of its header; None is now.
            topic: full name; the display's only one if it is not given.
        """
        if frame is not None:
            values = {**values, "header": header(frame, stamp_ns or self.now_ns)}
        self.send_bytes(type_name, encode(type_name, values), topic)

    def send_bytes(self, type_name: str, cdr: bytes, topic: str = "") -> None:
        """Publish a message as it is in a bag."""
        topic = topic or inputs(self.display)[0][2].name
        publisher = Publisher("/test", type_name, "reliable", "volatile")
        self.offers[topic] = Offer((publisher,), ("reliable", "volatile"))
        self._batches.setdefault(topic, []).append(Raw(cdr, self.now_ns))

    def serve(self, service: str, type: str, values: Mapping[str, Any]) -> None:
        """Answer a service with these values from now on."""
        self.graph.responses[service] = encode(interfaces.service(type).response, values)

    def offer(self, topic: str, type_name: str, publishers: int = 1) -> None:
        """Publish a topic that the display finds at run time."""
        publisher = Publisher("/test", type_name, "reliable", "volatile")
        offer = Offer((publisher,) * publishers, ("reliable", "volatile"), type=type_name)
        self.offers[topic] = offer

    def set(self, path: str, value: Any) -> None:
        """Change a property, and draw."""
        self.runner.set(path, value)
        self.turn()

    def turn(self, seconds: float = 0.0) -> None:
        """One tick of the frame loop, after some time."""
        self.now_ns += round(seconds * SECOND)
        batches, self._batches = self._batches, {}
        frames = Frames(self.buffer, self.fixed_frame, self.now_ns)
        self.runner.take(batches, frames, self.offers)
        self.runner.draw(frames)

    def settle(self) -> None:
        """Turn until all slow work is drawn."""
        deadline = time.monotonic() + PATIENCE_S
        while self.runner.is_busy():
            assert time.monotonic() < deadline, self.statuses()
            time.sleep(0.005)
            self.turn()

    def nodes(self) -> dict[str, Any]:
        """Return the visible nodes of `webviz.api.nodes` by key, with a number if several share it.

        They are `Any`, as a test knows the class of each.
        """
        return {key: node for key, _, node in self.scene.visible()}

    def poses(self) -> dict[str, Pose]:
        """Return where in the fixed frame each of `nodes` is."""
        return {key: pose for key, pose, _ in self.scene.visible()}

    def xyz(self, key: str) -> NDArray[np.float64]:
        """Positions, vertices or segments of a node in the fixed frame, wherever its group is."""
        pose, node = next((p, n) for name, p, n in self.scene.visible() if name == key)
        local = np.asarray(getattr(node, fields(node)[0].name), dtype=np.float64)
        placed = local.reshape(-1, 3) @ matrices(pose.wxyz).T + pose.position
        return placed.reshape(local.shape)

    def statuses(self) -> dict[str, tuple[str, str]]:
        """Level and sentence by key."""
        return {key: (status.level.name, status.text) for key, status in self._statuses().items()}

    def remedy(self, key: str) -> Remedy | None:
        """Return the property that would help, according to a status."""
        remedy = self._statuses()[key].remedy
        assert remedy is None or isinstance(remedy, Remedy)
        return remedy

    def fixed_frame_remedy(self, key: str) -> OtherFixedFrame | None:
        """Return the fixed frame that would help, according to a status."""
        remedy = self._statuses()[key].remedy
        assert remedy is None or isinstance(remedy, OtherFixedFrame)
        return remedy

    def pick(self, key: str, number: int | None, point: Any = None) -> Details:
        """Select an item of a node, as the tool Select does.

        Args:
            key: of the node.
            number: of the item, in the order that is drawn; None for a node without items.
            point: a point on it without items, in metres in the frame of the node's group.

        Returns:
            Details of the item, by its display.
        """
        group = next(group for group, nodes in self.scene.groups.items() if key in nodes)
        node, _ = self.scene.groups[group][key]
        color: Any = None
        if number is not None:
            place = getattr(node, fields(node)[0].name)[number]
            point = tuple(map(float, place[0] if place.ndim > 1 else place))
            if isinstance(node, Points) and not isinstance(node.colors, tuple):
                color = tuple(node.colors[number].tolist())
        hits = self.runner.find(NodePicks(group, key, ((7, number, point, color),)))
        frames = Frames(self.buffer, self.fixed_frame, self.now_ns)
        details = self.runner.inspect(hits[7], frames)
        assert details is not None, f"{key} cannot be selected."
        return details

    def press(self, key: str) -> None:
        """Do what the button of a status does, which must leave nothing to report there."""
        remedy = self.remedy(key)
        assert remedy is not None
        self.set(remedy.path, remedy.value)
        assert self.statuses().get(key, ("OK", ""))[0] == "OK"

    def _statuses(self) -> dict[str, Status]:
        frames = Frames(self.buffer, self.fixed_frame, self.now_ns)
        return self.runner.statuses(self.offers, frames, lambda topic: 0, is_watched=True)


def check_details(details: Details, title: str, values: Mapping[str, Any]) -> None:
    """Check what a display tells of a selected item.

    Args:
        details: what it tells.
        title: expected title.
        values: expected values by name, as they are shown; others do not matter.

    Raises:
        AssertionError: a title or a value is another one.
    """
    assert details.title == title
    fields = details_tree(details.values)["fields"]
    assert {name: fields.get(name) for name in values} == values
