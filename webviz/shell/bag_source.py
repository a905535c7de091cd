"""Bags as a source, with the arguments that ROS would get."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from webviz.api.errors import Error
from webviz.sources.bag.extras import Extra
from webviz.sources.bag.ghost import Ghost
from webviz.sources.bag.source import BagSource


def bag_source(
    paths: Path | Sequence[Path],
    extras: Sequence[Extra] = (),
    ros_args: Sequence[str] = (),
    ghost: Ghost | None = None,
) -> BagSource:
    """One or several bags, merged by time.

    Args:
        paths: MCAP files, db3 files or rosbag2 folders.
        extras: messages to add, see `webviz.sources.bag.extras`.
        ros_args: remappings of topics: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        ghost: a second run to show beside it.

    Raises:
        Error: a bag cannot be read, or an argument is unsupported.
    """
    return BagSource(paths, extras, _remappings(ros_args), ghost)


def _remappings(ros_args: Sequence[str]) -> dict[str, str]:
    """Topics by the names that displays use; other ROS arguments make no sense for a bag."""
    result = {}
    rest = [a for a in ros_args if a not in ("--ros-args", "--", "-r", "--remap")]
    for argument in rest:
        theirs, mark, ours = argument.partition(":=")
        if not mark or not theirs.startswith("/"):
            raise Error(
                f"{argument!r} is not supported with a bag. The only ROS argument is "
                "`-r /topic:=/other`."
            )
        result[theirs] = ours
    return result
