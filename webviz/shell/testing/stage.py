"""A viewer without ROS, for tests in which every message and every instant is said."""

from __future__ import annotations

import time

from webviz.files.config import Config
from webviz.shell.testing.pictures import Photographer
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.shown import Shown
from webviz.shell.testing.source import HandFedSource
from webviz.shell.testing.watched import WatchedViewer

__tracebackhide__ = True  # failures are shown where the test calls

LOADING_S = 60.0
"""A robot's meshes may be large."""


class Stage(Shown):
    """A viewer that does nothing by itself: `turn` is one turn of its frame loop.

    Args:
        config: what to show.
        photographer: of its scene.
    """

    def __init__(self, config: Config, scene: RecordingScene, photographer: Photographer) -> None:
        self.source = HandFedSource()
        self.clock = 1000.0
        """Seconds, for the ages of messages."""
        viewer = WatchedViewer(config, self.source, scene, clock=lambda: self.clock)
        super().__init__(viewer, scene, photographer)
        self.turn()

    def close(self) -> None:
        """End slow work."""
        self.viewer.close()

    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a message as it is in a bag; it is drawn in the next turn."""
        self.source.put(topic, type_name, cdr)

    def now_ns(self) -> int:
        """ROS time, which is `source.now`."""
        return self.source.now

    def turn(self) -> None:
        """One turn of the frame loop."""
        self.viewer.turn()

    def settle(self) -> None:
        """Turn until slow work of the displays is done."""
        deadline = time.monotonic() + LOADING_S
        self.turn()
        while self.viewer.is_busy():
            assert time.monotonic() < deadline, "A display still loads."
            time.sleep(0.02)
            self.turn()

    def wait_until_drawn(self, display: str) -> None:
        """Turn until a display has drawn what it was sent.

        Raises:
            AssertionError: nothing can be seen of it; its statuses say why.
        """
        self.settle()
        if not self.is_drawn(display):
            raise AssertionError(f"{display} draws nothing. {self.status(display).text}")

    def _catch_up(self) -> None:
        self.turn()
