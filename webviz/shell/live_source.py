"""Live topics: of the ROS graph, or through a bridge without ROS."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from webviz.shell.remappings import remappings
from webviz.shell.ros_source import ros_source

if TYPE_CHECKING:
    from webviz.sources import Source
    from webviz.sources.bridge.source import BridgeSource


def bridge_source(
    url: str,
    headers: str | os.PathLike[str] | None = None,
    ros_args: Sequence[str] = (),
) -> BridgeSource:
    """Return the topics of a bridge, which may be connected later.

    Args:
        url: such as ws://robot:8765.
        headers: file with headers for the bridge, see `webviz.sources.bridge.address`.
        ros_args: remappings of topics.

    Raises:
        Error: the URL, the file or an argument is invalid.
    """
    from webviz.sources.bridge.address import address
    from webviz.sources.bridge.source import BridgeSource

    renamed = remappings(ros_args, "a bridge")
    return BridgeSource(address(url, Path(headers) if headers else None), renamed)


def live_source(connect: str, headers: Path | None = None, ros_args: Sequence[str] = ()) -> Source:
    """Return the topics of a bridge, or of the ROS graph.

    Args:
        connect: URL of the bridge, "" for the ROS graph.
        headers: for the bridge.
        ros_args: command line arguments for ROS.

    Raises:
        Error: the connection is invalid, or ROS is missing or does not start.
    """
    return bridge_source(connect, headers, ros_args) if connect else ros_source(ros_args)
