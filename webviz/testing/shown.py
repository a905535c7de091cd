"""What a viewer under test shows: nodes in the fixed frame, statuses, pictures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from webviz import config as config_file
from webviz.browser import Pixels
from webviz.commands import SetFixedFrame, SetProperty
from webviz.nodes import (
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
from webviz.pipeline.baking import rotation_matrix
from webviz.state import Row, State
from webviz.status import Status
from webviz.testing.comparing import TOLERANCE, Box
from webviz.testing.messages import header, serialized
from webviz.testing.pictures import Photographer
from webviz.testing.recording import RecordingScene
from webviz.testing.watched import WatchedViewer
from webviz.views import View

F64 = NDArray[np.float64]
N = TypeVar("N")
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Shown(ABC):
    """A viewer whose scene a test can read, display by display.

    Displays are called by their names in the list, positions are in metres in the fixed frame.

    Args:
        viewer: draws into `scene`.
        scene: what is drawn.
        photographer: of that scene.
    """

    def __init__(
        self, viewer: WatchedViewer, scene: RecordingScene, photographer: Photographer
    ) -> None:
        self.viewer = viewer
        self.scene = scene
        self._photographer = photographer

    # Change what is shown

    @abstractmethod
    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a message as it is in a bag."""

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
            values: of a type that is named: nested mappings; fields left out are zero or empty.
            frame: gives such a message a header with this frame id and the time that it is now.
        """
        if not isinstance(message, str):
            from webviz.ros.talker import serialize  # only those who have rclpy make such messages

            self.publish_bytes(topic, *serialize(message))
            return
        values = dict(values or {})
        if frame is not None:
            values["header"] = header(frame, self.now_ns())
        self.publish_bytes(topic, message, serialized(message, values))

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
        stamped = {
            "header": header(parent, stamp_ns or 0),
            "child_frame_id": child,
            "transform": {
                "translation": dict(zip("xyz", xyz, strict=True)),
                "rotation": dict(zip("xyzw", xyzw, strict=True)),
            },
        }
        topic = "/tf_static" if stamp_ns is None else "/tf"
        self.publish(topic, "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})

    def set(self, path: str, value: Any, display: str | None = None) -> None:
        """Change a property.

        Args:
            path: of the property; nested ones have dots, such as `topic.name`.
            value: what its config would say.
            display: name; None is the first in the list.
        """
        done = self.viewer.enqueue(SetProperty(self._row(display).id, path, value))
        self._catch_up()
        done.result(0)

    def set_fixed_frame(self, frame: str) -> None:
        """Draw in another frame."""
        self.viewer.enqueue(SetFixedFrame(frame))
        self._catch_up()

    def look(self, view: View) -> None:
        """Move the camera of pictures."""
        self._photographer.view = view

    def resize(self, width: int, height: int) -> None:
        """Make pictures of another size in pixels."""
        album = self._photographer.album
        self._photographer.album = replace(album, size=(width, height))

    @abstractmethod
    def settle(self) -> None:
        """Let all that was published be drawn, and slow work of displays finish."""

    # Statuses

    def state(self) -> State:
        """What a panel would show."""
        return self.viewer.snapshot()

    def statuses(self, display: str | None = None) -> Mapping[str, Status]:
        """Level and sentence by key of a display, the first one if it is not named."""
        return self._row(display).statuses

    def status(self, display: str | None = None) -> Status:
        """The worst level of a display, and the sentences of that level."""
        row = self._row(display)
        texts = [f"{key}: {s.text}" for key, s in row.statuses.items() if s.level is row.level]
        return Status(row.level, "\n".join(texts))

    # What can be seen

    def nodes(self, display: str | None = None) -> dict[str, tuple[Pose, Node]]:
        """Everything of a display that can be seen: pose in the fixed frame and node, by key."""
        with self.scene.lock:
            seen = self.scene.visible(self._prefix(display))
            return {key: (pose, node) for key, pose, node in seen}

    def points(self, display: str | None = None) -> F64:
        """Positions (N, 3) of the points of a display."""
        return self._joined((0, 3), self._moved(display, Points))

    def lines(self, display: str | None = None) -> F64:
        """Both ends of each line of a display: (N, 2, 3)."""
        return self._joined((0, 2, 3), self._moved(display, Lines))

    def arrows(self, display: str | None = None) -> F64:
        """Tail and tip of each arrow of a display that is drawn as one: (N, 2, 3)."""
        return self._joined((0, 2, 3), self._moved(display, Arrows))

    def axes(self, display: str | None = None) -> F64:
        """Origins (N, 3) of the axes of a display."""
        return self._joined((0, 3), self._moved(display, Axes))

    def solids(self, display: str | None = None) -> F64:
        """Middles (N, 3) of the boxes, spheres, cylinders and cones of a display."""
        return self._joined((0, 3), self._moved(display, Instances))

    def meshes(self, display: str | None = None) -> list[F64]:
        """The vertices (N, 3) of each mesh of a display; not of those with textures."""
        return list(self._moved(display, Mesh))

    def labels(self, display: str | None = None) -> dict[str, Vector]:
        """Where each text of a display is."""
        return {
            text: tuple(position)
            for pose, node in self._of(display, Labels)
            for text, position in zip(
                node.texts, _moved(pose, node.positions).tolist(), strict=True
            )
        }

    def images(self, display: str | None = None) -> list[tuple[Pose, Image]]:
        """The flat pictures of a display, such as the tiles of a map."""
        return self._of(display, Image)

    def poses(self, display: str | None = None) -> dict[str, Pose]:
        """Where each node of a display is, by key: the links of a robot, say."""
        return {key: pose for key, (pose, _) in self.nodes(display).items()}

    def is_drawn(self, display: str | None = None) -> bool:
        """Whether anything can be seen of a display."""
        return any(has_content(node) for _, node in self.nodes(display).values())

    # Pictures

    def picture(self, transparent: bool = False) -> Pixels:
        """What a browser shows.

        Args:
            transparent: leave the background out.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) if transparent.
        """
        __tracebackhide__ = True
        self.settle()
        return self._photographer.capture(transparent)

    def check_picture(
        self,
        name: str,
        *,
        mask: Sequence[Box] = (),
        tolerance: float = TOLERANCE,
        each_display: bool | None = None,
    ) -> None:
        """Compare what a browser shows with a reference picture, or make that.

        Args:
            name: of the file, without suffix; may have folders.
            mask: boxes (left, top, right, bottom) in pixels that do not matter.
            tolerance: share of pixels that may differ.
            each_display: whether the picture must tell if any one of the displays were left out;
                None is as the ini option says.

        Raises:
            AssertionError: a person would see the difference; the text tells where to look.
        """
        __tracebackhide__ = True
        self.settle()
        if each_display is None:
            each_display = self._photographer.album.each_display
        must_be_seen = self._drawn() if each_display else {}
        self._photographer.check(name, must_be_seen, mask, tolerance)

    # Inside

    def _drawn(self) -> dict[str, str]:
        """Name and prefix of every display that draws something."""
        return {
            _name(row): f"{row.id}/"
            for row in self.state().rows
            if row.display is not None and any(_seen(self.scene, f"{row.id}/"))
        }

    def _row(self, display: str | None) -> Row:
        rows = self.state().rows
        if display is None:
            return rows[0]
        found = [row for row in rows if _name(row) == display]
        if not found:
            hint = config_file.nearest(display, {_name(row) for row in rows})
            raise LookupError(f"No display is named `{display}`, {hint}")
        if len(found) > 1:
            raise LookupError(f"{len(found)} displays are named `{display}`: give them names.")
        return found[0]

    def _prefix(self, display: str | None) -> str:
        return f"{self._row(display).id}/"

    def _of(self, display: str | None, kind: type[N]) -> list[tuple[Pose, N]]:
        nodes = self.nodes(display).values()
        return [(pose, node) for pose, node in nodes if isinstance(node, kind)]

    def _moved(self, display: str | None, kind: type[N]) -> Iterator[F64]:
        for pose, node in self._of(display, kind):
            # The first field of a node holds its coordinates.
            yield _moved(pose, getattr(node, fields(node)[0].name))  # pyright: ignore[reportArgumentType]

    @staticmethod
    def _joined(empty: tuple[int, ...], parts: Iterator[F64]) -> F64:
        return np.concatenate([np.empty(empty), *parts])


def _name(row: Row) -> str:
    """What the list of displays calls it."""
    return row.name or row.type


def _moved(pose: Pose, xyz: NDArray[np.floating[Any]]) -> F64:
    """Coordinates (..., 3) of a node, in those that its pose is given in."""
    turned = np.asarray(xyz, np.float64).reshape(-1, 3) @ rotation_matrix(pose).T
    return (turned + pose.position).reshape(xyz.shape)


def _seen(scene: RecordingScene, prefix: str) -> Iterator[bool]:
    with scene.lock:
        yield from [True for _, _, node in scene.visible(prefix) if has_content(node)]
