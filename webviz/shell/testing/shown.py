"""A viewer under test: publish messages, change properties, check pictures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from webviz.api.views import View
from webviz.commands import SetFixedFrame, SetProperty
from webviz.data.messages import encode
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing.comparing import TOLERANCE, PixelBox
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.pictures import SnapshotFixture
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.seen import Seen, Vector
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

Quaternion = tuple[float, float, float, float]


class Shown(Seen, ABC):
    """A viewer under test, whose content can be changed, read and compared with pictures.

    Args:
        viewer: draws in `scene`.
        scene: of the viewer.
        snapshot: takes pictures of the scene.
    """

    def __init__(
        self, viewer: WatchedViewer, scene: RecordingScene, snapshot: SnapshotFixture
    ) -> None:
        super().__init__(viewer, scene)
        self._snapshots = snapshot

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
        done = self.viewer.enqueue(SetProperty(self._row(display).id, path, value))
        self._catch_up()
        done.result(0)

    def set_fixed_frame(self, frame: str) -> None:
        """Change the fixed frame."""
        self.viewer.enqueue(SetFixedFrame(frame))
        self._catch_up()

    def look(self, view: View) -> None:
        """Change the view of pictures."""
        self._snapshots.view = view

    def resize(self, width: int, height: int) -> None:
        """Change the size of pictures, in pixels."""
        references = self._snapshots.references
        self._snapshots.references = replace(references, size=(width, height))

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
        return self._snapshots.capture(transparent)

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
            each_display = self._snapshots.references.each_display
        must_be_seen = self._drawn() if each_display else {}
        self._snapshots.check(name, must_be_seen, mask, tolerance)
