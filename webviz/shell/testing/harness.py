"""A viewer without ROS, for tests that control every message and the time."""

from __future__ import annotations

import time

from webviz.files.config import Config
from webviz.shell.testing.pictures import SnapshotFixture
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.shown import Shown
from webviz.shell.testing.source import HandFedSource
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

LOADING_S = 60.0
"""For the meshes of large robots."""


class Harness(Shown):
    """A viewer that only runs in `turn`, one turn of its frame loop.

    Args:
        config: to show.
        scene: to draw in.
        photographer: of the scene.
    """

    def __init__(self, config: Config, scene: RecordingScene, snapshot: SnapshotFixture) -> None:
        self.source = HandFedSource()
        self.clock = 1000.0
        """Monotonic time in seconds, for the ages of messages."""
        viewer = WatchedViewer(config, self.source, scene, clock=lambda: self.clock)
        super().__init__(viewer, scene, snapshot)
        self.turn()

    def close(self) -> None:
        """Stop the displays."""
        self.viewer.close()

    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a serialised message; it is drawn in the next turn."""
        self.source.put(topic, type_name, cdr)

    def now_ns(self) -> int:
        """ROS time, which is `source.now`."""
        return self.source.now

    def turn(self) -> None:
        """One turn of the frame loop."""
        self.viewer.turn()

    def settle(self) -> None:
        """Turn until all displays have loaded."""
        deadline = time.monotonic() + LOADING_S
        self.turn()
        while self.viewer.is_busy():
            assert time.monotonic() < deadline, "A display is still loading."
            time.sleep(0.02)
            self.turn()

    def wait_until_drawn(self, display: str) -> None:
        """Turn until a display has drawn its messages.

        Raises:
            AssertionError: it draws nothing; the message has its status.
        """
        self.settle()
        if not self.is_drawn(display):
            raise AssertionError(f"{display} draws nothing. {self.status(display).text}")

    def _catch_up(self) -> None:
        self.turn()
