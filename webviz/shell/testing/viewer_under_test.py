"""A viewer under test: publish messages, change properties, check pictures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import (
    Arrows,
    Axes,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Node,
    Points,
    Pose,
    has_content,
)
from webviz.api.status import Status
from webviz.api.views import View
from webviz.commands import SetFixedFrame, SetProperty
from webviz.data.messages import encode
from webviz.data.rotations import matrices
from webviz.engine.state import Row, State
from webviz.files import config as config_file
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing.comparing import TOLERANCE, PixelBox
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.pictures import SnapshotFixture
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

F64 = NDArray[np.float64]
N = TypeVar("N")
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class ViewerUnderTest(ABC):
    """A viewer under test, whose content can be changed, read and compared with pictures.

    Displays are given by name; None is the first in the list. Positions are in metres in the fixed
    frame.

    Args:
        viewer: draws in `scene`.
        scene: of the viewer.
        snapshot: takes pictures of the scene.
    """

    def __init__(
        self, viewer: WatchedViewer, scene: RecordingScene, snapshot: SnapshotFixture
    ) -> None:
        self.viewer = viewer
        self.scene = scene
        self.snapshots = snapshot
        """Takes the pictures."""

    # Statuses

    def state(self) -> State:
        """Return the state for panels."""
        return self.viewer.snapshot()

    def statuses(self, display: str | None = None) -> Mapping[str, Status]:
        """All statuses of a display by key."""
        return self._row(display).statuses

    def status(self, display: str | None = None) -> Status:
        """Return the worst level of a display, with the texts of all statuses of that level."""
        row = self._row(display)
        texts = [f"{key}: {s.text}" for key, s in row.statuses.items() if s.level is row.level]
        return Status(row.level, "\n".join(texts))

    # Nodes

    def nodes(self, display: str | None = None) -> dict[str, tuple[Pose, Node]]:
        """All visible nodes of a display with their poses in the fixed frame, by key."""
        with self.scene.lock:
            visible = self.scene.visible(self._prefix(display))
            return {key: (pose, node) for key, pose, node in visible}

    def points(self, display: str | None = None) -> F64:
        """Positions (N, 3) of the points of a display."""
        return self._joined((0, 3), self._moved(display, Points))

    def lines(self, display: str | None = None) -> F64:
        """End points (N, 2, 3) of the lines of a display."""
        return self._joined((0, 2, 3), self._moved(display, Lines))

    def arrows(self, display: str | None = None) -> F64:
        """Tails and tips (N, 2, 3) of the arrows of a display that are drawn as `Arrows`."""
        return self._joined((0, 2, 3), self._moved(display, Arrows))

    def axes(self, display: str | None = None) -> F64:
        """Origins (N, 3) of the axes of a display."""
        return self._joined((0, 3), self._moved(display, Axes))

    def solids(self, display: str | None = None) -> F64:
        """Centres (N, 3) of the boxes, spheres, cylinders and cones of a display."""
        return self._joined((0, 3), self._moved(display, Instances))

    def meshes(self, display: str | None = None) -> list[F64]:
        """Return the vertices (N, 3) of each mesh of a display, except those with textures."""
        return list(self._moved(display, Mesh))

    def labels(self, display: str | None = None) -> dict[str, Vector]:
        """Return the positions of the labels of a display by text."""
        return {
            text: tuple(position)
            for pose, node in self._of(display, Labels)
            for text, position in zip(
                node.texts, _moved(pose, node.positions).tolist(), strict=True
            )
        }

    def images(self, display: str | None = None) -> list[tuple[Pose, Image]]:
        """Return the images of a display, such as a map, with their poses."""
        return self._of(display, Image)

    def poses(self, display: str | None = None) -> dict[str, Pose]:
        """Return the poses of the nodes of a display by key, such as the links of a robot."""
        return {key: pose for key, (pose, _) in self.nodes(display).items()}

    def is_drawn(self, display: str | None = None) -> bool:
        """Return whether a display draws anything visible."""
        prefix = self._prefix(display)
        with self.scene.lock:
            return self._has_content(prefix)

    # Inside

    def _display_names(self) -> dict[str, str]:
        """Names of the displays that draw something, by the prefix of their groups."""
        with self.scene.lock:
            return {
                prefix: _name(row)
                for row in self.state().rows
                if self._has_content(prefix := f"{row.id}/")
            }

    def _has_content(self, prefix: str) -> bool:
        return any(has_content(node) for _, _, node in self.scene.visible(prefix))

    def _row(self, display: str | None) -> Row:
        rows = self.state().rows
        if display is None and rows:
            return rows[0]
        found = [row for row in rows if _name(row) == display]
        if not found:
            hint = config_file.nearest(display or "", {_name(row) for row in rows})
            raise LookupError(f"No display is named `{display}`, {hint}")
        if len(found) > 1:
            raise LookupError(
                f"{len(found)} displays are named `{display}`. Give them different names."
            )
        return found[0]

    def _prefix(self, display: str | None) -> str:
        return f"{self._row(display).id}/"

    def _of(self, display: str | None, kind: type[N]) -> list[tuple[Pose, N]]:
        nodes = self.nodes(display).values()
        return [(pose, node) for pose, node in nodes if isinstance(node, kind)]

    def _moved(self, display: str | None, kind: type[N]) -> Iterator[F64]:
        for pose, node in self._of(display, kind):
            # The first field of a node has its coordinates.
            yield _moved(pose, getattr(node, fields(node)[0].name))  # pyright: ignore[reportArgumentType]

    @staticmethod
    def _joined(empty: tuple[int, ...], parts: Iterator[F64]) -> F64:
        return np.concatenate([np.empty(empty), *parts])

    # Changes

    @abstractmethod
    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a serialised message."""

    @abstractmethod
    def now_ns(self) -> int:
        """ROS time."""

    @abstractmethod
    def _catch_up(self) -> None:
        """Wait for a whole turn of the frame loop."""

    def publish(
        self,
        topic: str,
        message: Any,
        values: Mapping[str, Any] | None = None,
        *,
        frame: str | None = None,
    ) -> None:
        """Publish a message.

        Args:
            topic: full name.
            message: a ROS message, or the name of a type such as "sensor_msgs/msg/LaserScan".
            values: nested mappings for a named type; missing fields are zero or empty.
            frame: adds a header with this frame id and the current time to `values`.
        """
        if not isinstance(message, str):
            from webviz.ros.publisher_node import serialize  # requires rclpy

            self.publish_bytes(topic, *serialize(message))
            return
        values = dict(values or {})
        if frame is not None:
            values["header"] = header(frame, self.now_ns())
        self.publish_bytes(topic, message, encode(message, values))

    def transform(
        self,
        parent: str,
        child: str,
        xyz: Vector = (0.0, 0.0, 0.0),
        xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0),
        *,
        stamp_ns: int | None = None,
    ) -> None:
        """Publish a transform, static unless it has a stamp."""
        stamped = stamped_transform(parent, child, stamp_ns or 0, xyz, xyzw)
        topic = "/tf_static" if stamp_ns is None else "/tf"
        self.publish(topic, "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})

    def set(self, path: str, value: Any, display: str | None = None) -> None:
        """Change a property.

        Args:
            path: of the property; dotted for nested ones, such as `topic.name`.
            value: as in a config file.
            display: name; None for the first in the list.
        """
        result = self.viewer.enqueue(SetProperty(self._row(display).id, path, value))
        self._catch_up()
        result.result(0)

    def set_fixed_frame(self, frame: str) -> None:
        """Change the fixed frame."""
        self.viewer.enqueue(SetFixedFrame(frame))
        self._catch_up()

    def look(self, view: View) -> None:
        """Change the view of pictures."""
        self.snapshots.view = view

    def resize(self, width: int, height: int) -> None:
        """Change the size of pictures, in pixels."""
        references = self.snapshots.references
        self.snapshots.references = replace(references, size=(width, height))

    @abstractmethod
    def settle(self) -> None:
        """Wait until all published messages are drawn, and all displays have loaded."""

    # Pictures

    def picture(self, transparent: bool = False) -> Pixels:
        """Return a picture of the scene.

        Args:
            transparent: omit the background.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) if transparent.
        """
        self.settle()
        return self.snapshots.capture(transparent)

    def check_picture(
        self,
        name: str,
        *,
        mask: Sequence[PixelBox] = (),
        tolerance: float = TOLERANCE,
        each_display: bool | None = None,
    ) -> None:
        """Compare the scene with a reference picture, or update that.

        Args:
            name: of the file, without suffix; may have folders.
            mask: boxes (left, top, right, bottom) in pixels to ignore.
            tolerance: share of pixels that may differ.
            each_display: whether every display must be visible in the picture; None for the ini
                option.

        Raises:
            AssertionError: there is a visible difference; the message names the files.
        """
        self.settle()
        if each_display is None:
            each_display = self.snapshots.references.each_display
        must_be_seen = self._display_names() if each_display else {}
        self.snapshots.check(name, must_be_seen, mask, tolerance)


def _name(row: Row) -> str:
    """Return the name in the list of displays."""
    return row.name or row.type


def _moved(pose: Pose, xyz: NDArray[np.floating[Any]]) -> F64:
    """Coordinates (..., 3) of a node, transformed by its pose."""
    turned = np.asarray(xyz, np.float64).reshape(-1, 3) @ matrices(pose.wxyz).T
    return (turned + pose.position).reshape(xyz.shape)
