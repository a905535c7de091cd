"""A viewer of live topics that receives a path a second."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import webviz
from webviz.commands import Refresh
from webviz.data.messages import encode
from webviz.shell.testing import header
from webviz.shell.testing.source import SECOND, HandFedSource

PATH = "nav_msgs/msg/Path"


def receive_path(source: HandFedSource) -> None:
    """Receive a path, a second of ROS time later."""
    source.now += SECOND
    source.put("/plan", PATH, encode(PATH, {"header": header("map", source.now)}))


@contextmanager
def path_viewer(source: HandFedSource, count: int = 1) -> Iterator[webviz.Viewer]:
    """A viewer that has received some paths."""
    with webviz.Viewer(port=0, source=source) as viewer:
        viewer.config = {"fixed_frame": "map", "displays": [{"type": "Path", "topic": "/plan"}]}
        for _ in range(count):
            viewer.do(Refresh())  # after the first one, the topic is subscribed to
            receive_path(source)
        viewer.do(Refresh())
        yield viewer
