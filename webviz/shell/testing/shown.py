"""A viewer under test: what is published to it, what it is told, and its pictures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from webviz.api.views import View
from webviz.data.messages import encode
from webviz.engine.commands import SetFixedFrame, SetProperty
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing.comparing import TOLERANCE, PixelBox
from webviz.shell.testing.messages import header
from webviz.shell.testing.pictures import Photographer
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.seen import Seen, Vector
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

Quaternion = tuple[float, float, float, float]


class Shown(Seen, ABC):
    """A viewer under test: what it shows can be changed, read, and compared with pictures.

    Args:
        viewer: draws into `scene`.
        scene: what is drawn.
        photographer: of that scene.
    """

    def __init__(
        self, viewer: WatchedViewer, scene: RecordingScene, photographer: Photographer
    ) -> None:
        super().__init__(viewer, scene)
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
            from webviz.edges.ros.talker import (
                serialize,  # only those who have rclpy make such messages
            )

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

    # Pictures

    def picture(self, transparent: bool = False) -> Pixels:
        """What a browser shows.

        Args:
            transparent: leave the background out.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) if transparent.
        """
        self.settle()
        return self._photographer.capture(transparent)

    def check_picture(
        self,
        name: str,
        *,
        mask: Sequence[PixelBox] = (),
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
        self.settle()
        if each_display is None:
            each_display = self._photographer.album.each_display
        must_be_seen = self._drawn() if each_display else {}
        self._photographer.check(name, must_be_seen, mask, tolerance)
